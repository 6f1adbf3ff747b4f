#pragma once
/// \file
/// A few numbers side by side, one for each of as many alike elements: arithmetic on all of them at once, in the
/// machine's vector registers. A kernel that is a template on its scalar and does not branch on values runs on packs as
/// it stands.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <cstring>

namespace polybody {

namespace detail {

template <int N>
struct LanesOf;  // a vector of 2 or 4: its length may not depend on a template's parameter
template <>
struct LanesOf<2> {
  using Type [[gnu::vector_size(16)]] = double;
};
template <>
struct LanesOf<4> {
  using Type [[gnu::vector_size(32)]] = double;
};

}  // namespace detail

/// As many doubles as the machine for which we compile takes at once, two or four (a wider vector than its own would be
/// taken apart entry by entry).
inline constexpr int pack_size = Eigen::internal::packet_traits<double>::size >= 4 ? 4 : 2;

/// `N` numbers. There is no `value_of`: a formula that takes branches does not compile for packs.
template <int N = pack_size>
class Pack {
 public:
  static constexpr int size = N;                    ///< how many numbers it holds
  using Lanes = typename detail::LanesOf<N>::Type;  ///< the compiler's vector of N doubles
  using Native =
      typename Eigen::internal::find_best_packet<double, N>::type;  ///< Eigen's name for `Lanes` where it has one

  Pack() = default;  ///< `Pack<>()` is zero, `Pack<> x;` is not made yet, as for double
  /// The same number N times.
  Pack(double same) : x_(same - Lanes{}) {}  // NOLINT(google-explicit-constructor): a constant is a pack

  double operator[](int i) const { return x_[i]; }  ///< number i, 0 ≤ i < N
  void set(int i, double x) { x_[i] = x; }          ///< makes x the number i

  ///@{
  /// Number by number.
  Pack& operator+=(Pack const& b) {
    x_ += b.x_;
    return *this;
  }
  Pack& operator-=(Pack const& b) {
    x_ -= b.x_;
    return *this;
  }
  Pack& operator*=(Pack const& b) {
    x_ *= b.x_;
    return *this;
  }
  Pack& operator/=(Pack const& b) {
    x_ /= b.x_;
    return *this;
  }
  ///@}
  friend Pack operator+(Pack a, Pack const& b) { return a += b; }
  friend Pack operator-(Pack a, Pack const& b) { return a -= b; }
  friend Pack operator*(Pack a, Pack const& b) { return a *= b; }
  friend Pack operator/(Pack a, Pack const& b) { return a /= b; }
  friend Pack operator-(Pack const& a) { return Pack(-a.x_); }
  friend Pack operator+(Pack const& a) { return a; }

  /// `N` numbers one after another in memory, aligned or not, the first at `from`.
  static Pack load(double const* from) {
    Pack r;
    std::memcpy(&r.x_, from, sizeof(Lanes));
    return r;
  }
  /// Writes the N numbers one after another, aligned or not, the first to `to`.
  void store(double* to) const { std::memcpy(to, &x_, sizeof(Lanes)); }

  /// `N` packs as the rows of a matrix become its columns.
  friend void transpose(std::array<Pack, std::size_t(N)>& packs) {
    if constexpr (sizeof(Native) == sizeof(Lanes)) {
      Eigen::internal::PacketBlock<Native, N> block;
      for (int i = 0; i < N; ++i) block.packet[i] = Native(packs[std::size_t(i)].x_);
      Eigen::internal::ptranspose(block);
      for (int i = 0; i < N; ++i) packs[std::size_t(i)].x_ = Lanes(block.packet[i]);
    } else {
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < i; ++j) {
          Pack &a = packs[std::size_t(i)], &b = packs[std::size_t(j)];
          double const kept = a[j];
          a.set(j, b[i]);
          b.set(i, kept);
        }
    }
  }

  friend Pack sqrt(Pack const& a) {
    if constexpr (sizeof(Native) == sizeof(Lanes))
      return Pack(
          Lanes(Eigen::internal::psqrt(Native(a.x_))));  // at once; std::sqrt stops to look for negative numbers
    else
      return each(a, [](double x) { return std::sqrt(x); });
  }
  friend Pack sin(Pack const& a) {
    return each(a, [](double x) { return std::sin(x); });
  }
  friend Pack cos(Pack const& a) {
    return each(a, [](double x) { return std::cos(x); });
  }

 private:
  explicit Pack(Lanes const& x) : x_(x) {}
  template <class F>
  static Pack each(Pack const& a, F&& f) {
    Pack r;
    for (int i = 0; i < N; ++i) r.x_[i] = f(a.x_[i]);
    return r;
  }

  Lanes x_;
};

/// What an element's kernel may be asked to run on: double, dual numbers, packs.
template <class T>
concept KernelScalar = requires(T x, double c) {
  { x + x } -> std::convertible_to<T>;
  { x* c } -> std::convertible_to<T>;
  { sqrt(x) } -> std::convertible_to<T>;
} || std::same_as<T, double>;

}  // namespace polybody

template <int N>
struct Eigen::NumTraits<polybody::Pack<N>> : Eigen::NumTraits<double> {
  using Real = polybody::Pack<N>;
  using NonInteger = polybody::Pack<N>;
  using Nested = polybody::Pack<N>;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};
