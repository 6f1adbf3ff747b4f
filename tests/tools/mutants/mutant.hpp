#pragma once
// Mutants chosen at run time: `Site<17>{} * x` is x, unless POLYBODY_MUTANT=17:f, then f x. tests/tools/mutants/run
// puts such sites into a copy of the headers, in front of the terms of formulas.
//   POLYBODY_MUTANT=SITE:FACTOR      the mutant of this process: factor -1, 0 or 1.01
//   POLYBODY_MUTANT_REACHED=FILE     writes the sites that the process reached; 1: the site changes a number, 2: none

#include <Eigen/Core>
#include <concepts>
#include <cstdio>
#include <cstdlib>
#include <type_traits>

namespace polybody::mutants {

inline constexpr int most_sites = 4096;

/// Mutant of this process from the environment, and the sites that the process reached.
struct Book {
  int site = -1;
  double factor = 1.0;
  unsigned char reached[most_sites] = {};  ///< 1: with a number, 2: only with values that are not numbers

  Book() {
    if (char const* asked = std::getenv("POLYBODY_MUTANT")) {
      if (std::sscanf(asked, "%d:%lf", &site, &factor) != 2) {
        std::abort();
      }
    }
  }
  ~Book() {
    char const* file = std::getenv("POLYBODY_MUTANT_REACHED");
    std::FILE* out = file ? std::fopen(file, "a") : nullptr;
    for (int i = 0; out && i < most_sites; ++i) {
      if (reached[i]) {
        std::fprintf(out, "%d %d\n", i, reached[i]);
      }
    }
    if (out) {
      std::fclose(out);
    }
  }
};
inline Book book;

/// Returns the factor of site `id` and records that the process reached it.
inline double factor_of(int id) {
  book.reached[id] = 1;
  return book.site == id ? book.factor : 1.0;
}

template <class T>
concept RealScalar =
    !std::integral<T> && !std::is_enum_v<T> && std::constructible_from<T, double> && requires(T a) { a* a; };

template <class T>
concept EigenNumbers = std::derived_from<T, Eigen::DenseBase<T>> && RealScalar<typename T::Scalar>;

template <class T>
concept NumberLike =
    std::is_class_v<T> && !std::derived_from<T, Eigen::EigenBase<T>> && requires(T const& x) { T(1.0 * x); };

/// Factor in front of a term.
template <int Id>
struct Site {
  static_assert(Id < most_sites);

  template <class T>
    requires std::floating_point<std::remove_cvref_t<T>>
  friend constexpr std::remove_cvref_t<T> operator*(Site, T&& x) {
    if (std::is_constant_evaluated()) {
      return x;
    }
    double const f = factor_of(Id);
    return f == 1.0 ? x : static_cast<std::remove_cvref_t<T>>(f * x);
  }

  template <class T>
    requires EigenNumbers<std::remove_cvref_t<T>>
  friend typename std::remove_cvref_t<T>::PlainObject operator*(Site, T&& x) {
    using Plain = typename std::remove_cvref_t<T>::PlainObject;
    Plain y(x);
    double const f = factor_of(Id);
    if (f != 1.0) {
      y *= typename Plain::Scalar(f);
    }
    return y;
  }

  template <class T>
    requires NumberLike<std::remove_cvref_t<T>>
  friend std::remove_cvref_t<T> operator*(Site, T&& x) {
    double const f = factor_of(Id);
    return f == 1.0 ? std::remove_cvref_t<T>(x) : std::remove_cvref_t<T>(f * x);
  }

  /// Integers, pointers, views and other types remain unchanged.
  template <class T>
  friend constexpr T operator*(Site, T&& x) {
    if (!std::is_constant_evaluated() && book.reached[Id] == 0) {
      book.reached[Id] = 2;
    }
    return static_cast<T&&>(x);
  }
};

}  // namespace polybody::mutants
