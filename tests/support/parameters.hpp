#pragma once
/// \file Sets every number among a type's parameters to invalid or extreme values.

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <tuple>
#include <variant>
#include <vector>

#include <polybody/joints/joint_axis.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// The words of an error message for each field of an aggregate T, in order. '|' separates alternatives, and a nested
/// aggregate has its own words. `tests/house/check_parameters.py` requires an entry for every type with a check. An
/// entry whose number of words differs from the type's number of fields does not compile.
template <class T>
inline constexpr auto words_of = nullptr;

template <class... Word>
constexpr auto words(Word... word) {
  return std::array<char const*, sizeof...(Word)>{word...};
}
template <class T>
concept HasWords = !std::is_same_v<decltype(words_of<T>), std::nullptr_t const>;

/// References to the n fields of an aggregate.
template <std::size_t n, class T>
auto fields_of(T& x) {
  if constexpr (n == 1) {
    auto& [a] = x;
    return std::tie(a);
  } else if constexpr (n == 2) {
    auto& [a, b] = x;
    return std::tie(a, b);
  } else if constexpr (n == 3) {
    auto& [a, b, c] = x;
    return std::tie(a, b, c);
  } else if constexpr (n == 4) {
    auto& [a, b, c, d] = x;
    return std::tie(a, b, c, d);
  } else if constexpr (n == 5) {
    auto& [a, b, c, d, e] = x;
    return std::tie(a, b, c, d, e);
  } else if constexpr (n == 6) {
    auto& [a, b, c, d, e, f] = x;
    return std::tie(a, b, c, d, e, f);
  } else if constexpr (n == 7) {
    auto& [a, b, c, d, e, f, g] = x;
    return std::tie(a, b, c, d, e, f, g);
  } else if constexpr (n == 8) {
    auto& [a, b, c, d, e, f, g, h] = x;
    return std::tie(a, b, c, d, e, f, g, h);
  } else if constexpr (n == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = x;
    return std::tie(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (n == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = x;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (n == 13) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = x;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m);
  } else {
    static_assert(n == 1, "add this number of fields to fields_of");
  }
}

/// Callback after the change of a number, with its words and its value.
using Changed = std::function<void(std::string const& words, std::string const& value)>;

inline void each_hostile(double& x, std::string const& words, Changed const& changed) {
  constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  double const sane = x;
  for (double const hostile :
       {nan, inf, -inf, 0.0, -1.0, 1e308, -1e308, 1e-308, std::numeric_limits<double>::denorm_min()}) {
    x = hostile;
    changed(words, number(hostile));
  }
  x = sane;
}
template <class I>
  requires(std::is_integral_v<I> && !std::is_same_v<I, bool>)
void each_hostile(I& x, std::string const& words, Changed const& changed) {
  I const sane = x;
  for (I const hostile : {I(0), I(-1), std::numeric_limits<I>::max(), std::numeric_limits<I>::min()}) {
    x = hostile;
    changed(words, std::to_string(hostile));
  }
  x = sane;
}
/// Every entry; for a matrix whose size is known at run time only the first and the last entry.
template <class T, int n, int m>
void each_hostile(Eigen::Matrix<T, n, m>& x, std::string const& words, Changed const& changed) {
  bool const every = n != Eigen::Dynamic && m != Eigen::Dynamic;
  for (Index i = 0; i < x.size(); ++i)
    if (every || i == 0 || i == x.size() - 1) each_hostile(x.data()[i], words, changed);
}
template <class T>
void each_hostile(Required<T>& x, std::string const& words, Changed const& changed) {
  each_hostile(x.value, words, changed);
}
template <class T>
  requires std::is_base_of_v<JointAxis, T>
void each_hostile(T& x, std::string const& words, Changed const& changed) {
  T const sane = x;
  Vec3 v = x;
  each_hostile(v, words, [&](std::string const& w, std::string const& value) {
    x = T(v);
    changed(w, value);
  });
  x = sane;
}
/// Flags, names, kinds and functions are skipped.
template <class T>
  requires(std::is_same_v<T, bool> || std::is_enum_v<T> || std::is_same_v<T, std::string>)
void each_hostile(T&, std::string const&, Changed const&) {}
template <class F>
void each_hostile(std::function<F>&, std::string const&, Changed const&) {}
/// Shared constant objects are skipped; the model sets them.
template <class T>
void each_hostile(std::shared_ptr<T const>&, std::string const&, Changed const&) {}
template <HasWords T>
void each_hostile(T& x, std::string const&, Changed const& changed);
template <class T>
void each_hostile(std::vector<T>& x, std::string const& words, Changed const& changed) {
  for (T& entry : x) each_hostile(entry, words, changed);
}
template <class T, std::size_t n>
void each_hostile(std::array<T, n>& x, std::string const& words, Changed const& changed) {
  for (T& entry : x) each_hostile(entry, words, changed);
}
template <class T>
void each_hostile(std::optional<T>& x, std::string const& words, Changed const& changed) {
  bool const given = x.has_value();
  if constexpr (std::is_arithmetic_v<T>)
    if (!given) x = T{};
  if (x) each_hostile(*x, words, changed);
  if (!given) x.reset();
}
template <class... T>
void each_hostile(std::variant<T...>& x, std::string const& words, Changed const& changed) {
  std::visit(
      [&]<class Held>(Held& held) {
        if constexpr (!std::is_same_v<Held, std::monostate>) each_hostile(held, words, changed);
      },
      x);
}
template <class... T>
void each_hostile(std::tuple<T...>& x, std::string const& words, Changed const& changed) {
  std::apply([&](auto&... each) { (each_hostile(each, words, changed), ...); }, x);
}
template <HasWords T>
void each_hostile(T& x, std::string const&, Changed const& changed) {
  auto const& word = words_of<T>;
  auto const all = fields_of<std::tuple_size_v<std::remove_cvref_t<decltype(word)>>>(x);
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (each_hostile(std::get<i>(all), word[i], changed), ...);
  }(std::make_index_sequence<std::tuple_size_v<std::remove_cvref_t<decltype(word)>>>{});
}

/// Checks that `message` contains one of `words`, without regard to case.
inline bool names_one_of(std::string message, std::string const& words) {
  for (char& c : message) c = char(std::tolower(static_cast<unsigned char>(c)));
  std::stringstream list(words);
  for (std::string word; std::getline(list, word, '|');) {
    for (char& c : word) c = char(std::tolower(static_cast<unsigned char>(c)));
    if (message.find(word) != std::string::npos) return true;
  }
  return false;
}

/// Selects one number in `every`, or every number if POLYBODY_HOSTILE is "all".
struct Share {
  int every = 1;
  bool takes(int i) const {
    char const* const asked = std::getenv("POLYBODY_HOSTILE");
    return i % every == 0 || (asked && std::string_view(asked) == "all");
  }
};

/// Replaces each number of `sane` in turn by an invalid or extreme value and calls `run(x)`. The run either succeeds
/// and checks its own result, or it throws. The exception must be an InvalidInput with one of the words of the
/// parameter, or another Error from within a run that names time or load. Returns the number of values tried.
template <class T, class Run>
int try_hostile(T sane, std::string const& type, Run const& run, Share share = {}) {
  int tried = 0, met = 0;
  each_hostile(sane, "", [&](std::string const& words, std::string const& value) {
    if (!share.takes(met++)) return;
    ++tried;
    std::string const where = type + ", " + words + " = " + value;
    SCOPED_TRACE(where);
    try {
      run(std::as_const(sane));
    } catch (InvalidInput const& error) {  // a motion that such a number makes jump, and the clock of a run, are named
      EXPECT_TRUE(names_one_of(error.what(), words + "|coordinate of body|the prescribed |double precision resolves"))
          << where << ": " << error.what();
    } catch (Error const& error) {
      EXPECT_TRUE(names_one_of(error.what(), words + "| t = | load factor |violates") &&
                  !names_one_of(error.what(), "by nan"))
          << where << ": " << error.what();
    } catch (std::exception const& error) {
      ADD_FAILURE() << where << ": a foreign exception, " << error.what();
    }
  });
  return tried;
}

}  // namespace polybody
