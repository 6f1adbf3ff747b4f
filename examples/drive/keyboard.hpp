#pragma once
// Reader of single keys from a terminal, without an end of line.
#include <termios.h>

namespace drive {

enum class Key { none, faster, slower, left, right, straight, stop, quit };

class Keyboard {
 public:
  // Changes the mode of the terminal; the destructor restores the mode. \throws polybody::InvalidInput if the standard
  // input is not a terminal.
  Keyboard();
  ~Keyboard();
  Keyboard(Keyboard const&) = delete;
  Keyboard& operator=(Keyboard const&) = delete;

  Key next();  // next key that was pressed; `none` if there is no further key

 private:
  termios before_{};
};

}  // namespace drive
