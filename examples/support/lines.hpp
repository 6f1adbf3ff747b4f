#pragma once
// Numbers in lines that are easy to read and to take apart: "  what: quantity number unit, quantity number unit".
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
  int digits;  // after the point; of a number with an exponent, less than zero
  std::string unit = "";
};

// Writes each line once, by its key; figures and reports have lines in common.
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
