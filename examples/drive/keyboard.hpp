#pragma once
// Keys as they are pressed, of a terminal that waits for no end of line meanwhile.
#include <termios.h>

namespace drive {

enum class Key { none, faster, slower, left, right, straight, stop, quit };

class Keyboard {
 public:
  // \throws polybody::InvalidInput if the input is not a terminal.
  Keyboard();
  ~Keyboard();
  Keyboard(Keyboard const&) = delete;
  Keyboard& operator=(Keyboard const&) = delete;

  Key next();  // what was pressed and not asked for yet

 private:
  termios before_{};
};

}  // namespace drive
