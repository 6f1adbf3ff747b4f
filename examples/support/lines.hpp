#pragma once
// Printer of numbers in lines that people and programs can read: "  what: quantity number unit, quantity number unit".
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <set>
#include <string>
#include <vector>

struct Value {
  std::string quantity;
  double number;
  int digits;  // digits after the point; negative: the number is printed with an exponent
  std::string unit = "";
};

// Prints each line only once, because figures and reports share lines. `what` identifies a line.
class Lines {
 public:
  void operator()(std::string const& what, std::vector<Value> const& values, std::string const& remark = "") {
    if (!written_.insert(what).second) return;
    std::string line = "  " + what + ":";
    for (Value const& v : values) {
      char text[64];
      bool const nothing = v.digits >= 0 && std::abs(v.number) < 0.5 * std::pow(10.0, -v.digits);  // not "-0.0"
      std::snprintf(text, sizeof text, v.digits < 0 ? " %.*e" : " %.*f", std::abs(v.digits), nothing ? 0.0 : v.number);
      line += (line.back() == ':' ? " " : ", ") + v.quantity + text + (v.unit.empty() ? "" : " " + v.unit);
    }
    std::cout << line << (remark.empty() ? "" : "; " + remark) << std::endl;
  }

 private:
  std::set<std::string> written_;
};
