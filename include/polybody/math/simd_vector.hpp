#pragma once
/// \file
/// SIMD vectors: several numbers in one register. Each operation applies to all numbers at once. In the kernel of an
/// element, each number belongs to a different finite element of the same type. A kernel that is a template of its
/// scalar and has no branches on values also compiles for SIMD vectors.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <cstring>

#include <polybody/math/compiler.hpp>

namespace polybody {

namespace detail {

template <int N>
struct SimdLanes;  // vector of 2 or 4 doubles; the attribute does not accept a template parameter as size
template <>
struct SimdLanes<2> {
  using Type [[gnu::vector_size(16)]] = double;
};
template <>
struct SimdLanes<4> {
  using Type [[gnu::vector_size(32)]] = double;
};

}  // namespace detail

/// Number of doubles in a SIMD vector of the target machine, two or four. The compiler splits a vector that is wider
/// than the registers of the machine into single entries.
inline constexpr int simd_size = Eigen::internal::packet_traits<double>::size >= 4 ? 4 : 2;

/// SIMD vector of `N` doubles. It has no `value_of`: a formula that branches on values does not compile for it.
template <int N = simd_size>
class SimdVector {
 public:
  static constexpr int size = N;                      ///< number of entries
  using Lanes = typename detail::SimdLanes<N>::Type;  ///< the compiler's vector of N doubles
  using Native =
      typename Eigen::internal::find_best_packet<double, N>::type;  ///< Eigen's type for `Lanes`, if there is one

  SimdVector() = default;  ///< `SimdVector<>()` is zero, `SimdVector<> x;` is not initialised, as for double
  /// N copies of the number `same`.
  SimdVector(double same) : x_(same - Lanes{}) {}  // NOLINT(google-explicit-constructor): a constant is a SIMD vector

  double operator[](int i) const { return x_[i]; }  ///< entry i, 0 ≤ i < N
  void set(int i, double x) { x_[i] = x; }          ///< sets entry i to x

  ///@{
  /// Operation entry by entry.
  SimdVector& operator+=(SimdVector const& b) {
    x_ += b.x_;
    return *this;
  }
  SimdVector& operator-=(SimdVector const& b) {
    x_ -= b.x_;
    return *this;
  }
  SimdVector& operator*=(SimdVector const& b) {
    x_ *= b.x_;
    return *this;
  }
  SimdVector& operator/=(SimdVector const& b) {
    x_ /= b.x_;
    return *this;
  }
  ///@}
  friend SimdVector operator+(SimdVector a, SimdVector const& b) { return a += b; }
  friend SimdVector operator-(SimdVector a, SimdVector const& b) { return a -= b; }
  friend SimdVector operator*(SimdVector a, SimdVector const& b) { return a *= b; }
  friend SimdVector operator/(SimdVector a, SimdVector const& b) { return a /= b; }
  friend SimdVector operator-(SimdVector const& a) { return SimdVector(-a.x_); }
  friend SimdVector operator+(SimdVector const& a) { return a; }

  /// Loads `N` numbers that are contiguous in memory, aligned or not, the first at `from`.
  static SimdVector load(double const* from) {
    SimdVector r;
    std::memcpy(&r.x_, from, sizeof(Lanes));
    return r;
  }
  /// Stores the N numbers contiguously, aligned or not, the first at `to`.
  void store(double* to) const { std::memcpy(to, &x_, sizeof(Lanes)); }

  /// Transposes the N×N matrix with the SIMD vectors in `vectors` as its rows.
  friend void transpose(std::array<SimdVector, std::size_t(N)>& vectors) {
    if constexpr (sizeof(Native) == sizeof(Lanes)) {
      Eigen::internal::PacketBlock<Native, N> block;
      for (int i = 0; i < N; ++i) block.packet[i] = Native(vectors[std::size_t(i)].x_);
      Eigen::internal::ptranspose(block);
      for (int i = 0; i < N; ++i) vectors[std::size_t(i)].x_ = Lanes(block.packet[i]);
    } else {
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < i; ++j) {
          SimdVector &a = vectors[std::size_t(i)], &b = vectors[std::size_t(j)];
          double const kept = a[j];
          a.set(j, b[i]);
          b.set(i, kept);
        }
    }
  }

  friend SimdVector sqrt(SimdVector const& a) {
    if constexpr (sizeof(Native) == sizeof(Lanes))
      return SimdVector(
          Lanes(Eigen::internal::psqrt(Native(a.x_))));  // one instruction; std::sqrt also checks for negative numbers
    else
      return each(a, [](double x) { return std::sqrt(x); });
  }
  friend SimdVector sin(SimdVector const& a) {
    return each(a, [](double x) { return std::sin(x); });
  }
  friend SimdVector cos(SimdVector const& a) {
    return each(a, [](double x) { return std::cos(x); });
  }

 private:
  explicit SimdVector(Lanes const& x) : x_(x) {}
  template <class F>
  static SimdVector each(SimdVector const& a, F&& f) {
    SimdVector r;
    for (int i = 0; i < N; ++i) r.x_[i] = f(a.x_[i]);
    return r;
  }

  Lanes x_;
};

/// Scalar type of an element's kernel: double, dual number, tape variable or SIMD vector.
template <class T>
concept KernelScalar = requires(T x, double c) {
  { x + x } -> std::convertible_to<T>;
  { x* c } -> std::convertible_to<T>;
  { sqrt(x) } -> std::convertible_to<T>;
} || std::same_as<T, double>;

}  // namespace polybody

template <int N>
struct Eigen::NumTraits<polybody::SimdVector<N>> : Eigen::NumTraits<double> {
  using Real = polybody::SimdVector<N>;
  using NonInteger = polybody::SimdVector<N>;
  using Nested = polybody::SimdVector<N>;
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
