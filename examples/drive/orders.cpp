#include <polybody/io/text_files.hpp>
#include <polybody/math/errors.hpp>

#include <sstream>

#include "throttle.hpp"

std::vector<drive::Order> drive::read_orders(std::filesystem::path const& file) {
  using polybody::IoError;
  std::optional<std::string> const text = polybody::detail::content_of(file);
  if (!text) throw IoError{"The file of orders \"", file.string(), "\" cannot be read."};
  std::vector<Order> orders;
  std::istringstream lines(*text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (number == 1 || line.empty()) continue;
    Order order{};
    char const* at = line.c_str();
    int taken = 0;
    if (std::sscanf(at, "%lf,%lf,%lf%n", &order.t, &order.left, &order.right, &taken) != 3 || at[taken] != '\0' ||
        !std::isfinite(order.t) || !std::isfinite(order.left) || !std::isfinite(order.right))
      throw IoError{
          "The drive \"",
          file.string(),
          "\", line ",
          number,
          ": expected a time [s] and the speeds of the left and right drive [rad/s], with commas, but there is \"",
          line,
          "\"."};
    if (!orders.empty() && order.t < orders.back().t)
      throw IoError{"The drive \"", file.string(), "\", line ", number, ": the times of the orders must not decrease."};
    orders.push_back(order);
  }
  if (orders.empty())
    throw IoError{"The drive \"", file.string(), "\" has no orders. Add lines of t,left,right below the head line."};
  return orders;
}
