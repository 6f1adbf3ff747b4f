#pragma once
/// \file
/// The concept of a force element: wrenches on its markers as a function of their frames. Its tangent comes from dual
/// numbers.

#include <array>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// The concept of a force element; `check(name)` is called by `apply` with its name. It may have a member `law` with
/// `corners()`, times at which steps are to end; `docs/extending.md` lists what else.
template <class F>
concept ForceElement =
    requires(F const force, std::array<Frame<double>, F::markers> const frames, double t, std::string const name) {
      requires F::markers >= 1;
      { F::needs } -> std::convertible_to<Observes>;
      { F::is_load } -> std::convertible_to<bool>;  // scaled by the load factor of `equilibrium`
      { force.template wrenches<double>(frames, t) } -> std::same_as<std::array<Wrench<double>, F::markers>>;
      force.check(name);
    };

/// What the second marker of a force element must observe: `needs_of_second`, or `needs` as for the first.
template <class F>
  requires requires { F::markers; }
constexpr Observes needs_of_second() {
  if constexpr (requires { F::needs_of_second; })
    return F::needs_of_second;
  else
    return F::needs;
}

/// The markers Ms of a force element F, in their order, tell what it asks of them.
template <class F, class... Ms>
constexpr bool tell_enough() {
  int k = 0;
  return ((Ms::observes >= (k++ == 1 ? needs_of_second<F>() : F::needs)) && ...);
}

/// A force element may leave the blocks that couple its markers' bodies out of a time step's matrix by
/// `static constexpr bool couples_bodies = false`: then Newton's matrix holds each body's own stiffness only. This is
/// for contacts of many candidates: the pattern of the matrix and the order of its elimination stay as they are without
/// contact, whichever candidates touch.
template <class F>
constexpr bool couples_bodies() {
  if constexpr (requires { F::couples_bodies; })
    return F::couples_bodies;
  else
    return true;
}

/// A force element that stores energy: a function of its frames and time [J].
template <class F>
concept HasPotential = requires(F const force, std::array<Frame<double>, F::markers> const frames, double t) {
  { force.potential(frames, t) } -> std::convertible_to<double>;
};

namespace detail {
/// Knows no force: those of as many markers share it. Frames as functions of their poses (δr, δφ in world axes), seeded
/// with ck, and twists, seeded with cd.
template <std::size_t N>
std::array<Frame<Dual<int(6 * N)>>, N> seeded(std::array<Frame<double>, N> const& frames, double ck, double cd) {
  using D = Dual<int(6 * N)>;
  auto const seed = [](double value, int i, double slope) {
    D x(value);
    x.d[i] = slope;
    return x;
  };
  std::array<Frame<D>, N> moved;
  for (int k = 0; k < int(N); ++k) {
    for (int i = 0; i < 3; ++i) {
      moved[k].r[i] = seed(frames[k].r[i], 6 * k + i, ck);
      moved[k].v[i] = seed(frames[k].v[i], 6 * k + i, cd);
      moved[k].w[i] = seed(frames[k].w[i], 6 * k + 3 + i, cd);
      int const j = (i + 1) % 3, l = (i + 2) % 3;
      for (int c = 0; c < 3; ++c) {  // δA = δφ × A
        moved[k].A(i, c) = seed(frames[k].A(i, c), 6 * k + 3 + j, ck * frames[k].A(l, c));
        moved[k].A(i, c).d[6 * k + 3 + l] = -ck * frames[k].A(j, c);
      }
    }
  }
  return moved;
}
template <std::size_t N>
Mat<double, int(6 * N), int(6 * N)> slopes(std::array<Wrench<Dual<int(6 * N)>>, N> const& w) {
  constexpr int n = int(6 * N);
  Mat<double, n, n> gradient;
  for (int k = 0; k < int(N); ++k)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < n; ++j) {
        gradient(6 * k + i, j) = w[k].f[i].d[j];
        gradient(6 * k + 3 + i, j) = w[k].m[i].d[j];
      }
  return gradient;
}
}  // namespace detail

/// Gradients of all wrenches with respect to the frames' poses (δr, δφ in world axes) and twists,
/// ck ∂w/∂pose + cd ∂w/∂twist, 6N×6N: one pass of dual numbers, pose seeded with ck, twist with cd.
template <ForceElement F>
Mat<double, 6 * F::markers, 6 * F::markers> wrench_gradient(F const& force,
                                                            std::array<Frame<double>, F::markers> const& frames,
                                                            double t, double ck, double cd) {
  return detail::slopes(force.template wrenches<Dual<6 * F::markers>>(detail::seeded(frames, ck, cd), t));
}

}  // namespace polybody
