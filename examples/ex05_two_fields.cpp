// Lesson: two independent fields are two curves (Figure 2.1 of the thesis). u1 = q sin(pi x/L) and u2 = q sin(2 pi x/L)
// meet only at rest, and for the same amplitude their curvatures differ by a factor of four.
// Writes ex05_two_fields.png (three panels). Sample run:
//   largest curvature of u1: 0.0987 1/m, of u2: 0.3948 1/m, ratio 4.000
#include <polybody/polybody.hpp>

#include <cstdio>
#include <numbers>
using namespace polybody;

int main() {
  // 1. The second derivative of a field, from its first derivative with dual numbers.
  double const length = 10.0, amplitude = 1.0, pi = std::numbers::pi;
  auto const slope = [&](int mode, auto const& x) {
    using std::cos;
    return cos(x * (mode * pi / length)) * (amplitude * mode * pi / length);
  };
  Figure fields[3] = {{.title = "a) u_1 = q sin(pi x/L)", .x_label = "x [m]", .y_label = "u_1 [m]"},
                      {.title = "b) u_2 = q sin(2 pi x/L)", .x_label = "x [m]", .y_label = "u_2 [m]"},
                      {.title = "c) curvatures for the same q", .x_label = "x [m]", .y_label = "|d^2u/dx^2| [1/m]"}};
  double largest[2] = {0.0, 0.0};
  for (int mode = 1; mode <= 2; ++mode) {
    Curve shape{.colour = mode - 1}, curvature{.label = mode == 1 ? "of u_1" : "of u_2", .colour = mode - 1};
    for (int i = 0; i <= 200; ++i) {
      double const x = length * i / 200.0;
      shape.x.push_back(x);
      shape.y.push_back(amplitude * std::sin(mode * pi * x / length));
      double const second = slope(mode, Dual<1>::variable(x, 0)).d[0];
      curvature.x.push_back(x);
      curvature.y.push_back(std::abs(second));
      largest[mode - 1] = std::max(largest[mode - 1], std::abs(second));
    }
    fields[mode - 1].curves.push_back(shape);
    fields[mode - 1].legend = false;
    fields[2].curves.push_back(curvature);
  }
  // 2. The picture.
  write_panels({fields[0], fields[1], fields[2]}, 3, "ex05_two_fields");
  // 3. The result.
  std::printf("largest curvature of u1: %.4f 1/m, of u2: %.4f 1/m, ratio %.3f\n", largest[0], largest[1],
              largest[1] / largest[0]);
  return std::abs(largest[1] / largest[0] - 4.0) < 1e-3 ? 0 : 1;
}
