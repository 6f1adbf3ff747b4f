#include "keyboard.hpp"

#include <poll.h>
#include <unistd.h>

#include <polybody/math/errors.hpp>

namespace drive {

Keyboard::Keyboard() {
  if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &before_) != 0)
    throw polybody::InvalidInput(
        "The keys of the driver are read from a terminal, but the standard input is not a terminal. Read the orders "
        "from a file: --drive FILE.");
  termios keys = before_;
  keys.c_lflag &= ~tcflag_t(ICANON | ECHO);
  tcsetattr(STDIN_FILENO, TCSANOW, &keys);
}
Keyboard::~Keyboard() { tcsetattr(STDIN_FILENO, TCSANOW, &before_); }

Key Keyboard::next() {
  auto const read_one = [](char& c) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    return poll(&input, 1, 0) == 1 && read(STDIN_FILENO, &c, 1) == 1;
  };
  char c = 0;
  if (!read_one(c)) return Key::none;
  if (c == '\033' && read_one(c) && c == '[' && read_one(c)) {  // arrows
    constexpr char const* arrows = "ABCD";
    constexpr Key keys[] = {Key::faster, Key::slower, Key::right, Key::left};
    for (int i = 0; i < 4; ++i)
      if (c == arrows[i]) return keys[i];
    return Key::none;
  }
  switch (c) {
    case 'w':
      return Key::faster;
    case 's':
      return Key::slower;
    case 'a':
      return Key::left;
    case 'd':
      return Key::right;
    case 'x':
      return Key::straight;
    case ' ':
      return Key::stop;
    case 'q':
      return Key::quit;
    default:
      return Key::none;
  }
}

}  // namespace drive
