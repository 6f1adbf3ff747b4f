#pragma once
/// \file
/// Concept of a force element: wrenches on its markers as a function of their frames. Dual numbers provide the
/// tangent of the wrenches.
/// Theory: Eqs. 3.1 to 3.3.

#include <array>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Number of first-order states of a force element: `static constexpr int states`, or zero without this member.
template <class F>
constexpr int states_of() {
  if constexpr (requires { F::states; })
    return F::states;
  else
    return 0;
}

/// Wrenches on the markers as a function of their frames.
template <class F>
concept WrenchFunction = requires(F const force, std::array<Frame<double>, F::markers> const frames, double t) {
  { force.template wrenches<double>(frames, t) } -> std::same_as<std::array<Wrench<double>, F::markers>>;
};
/// Force element with first-order states z, such as a controller, a valve or a viscoelastic material. It provides
/// wrenches as a function of frames and states, and the rates ż = h(frames, z, t). The optional `initial_states()`
/// returns z in the reference state. Without this member, z is zero there.
template <class F>
concept HasStates = states_of<F>() > 0 && requires(F const force, std::array<Frame<double>, F::markers> const frames,
                                                   std::array<double, states_of<F>()> const z, double t) {
  { force.template wrenches<double>(frames, z, t) } -> std::same_as<std::array<Wrench<double>, F::markers>>;
  { force.template rates<double>(frames, z, t) } -> std::same_as<std::array<double, states_of<F>()>>;
};

/// Concept of a force element. `apply` calls `check(name)` with the name of the element. The optional member `law`
/// with `breakpoints()` contains the breakpoints, at which steps end. `docs/extending.md` lists the other optional
/// members.
template <class F>
concept ForceElement = requires(F const force, std::string const name) {
  requires F::markers >= 1;
  { F::needs } -> std::convertible_to<MarkerKind>;
  { F::is_load } -> std::convertible_to<bool>;  // true: scaled by the load factor of `equilibrium`
  force.check(name);
} && (WrenchFunction<F> || HasStates<F>);

/// Kinematics that a force element requires of its second marker: `needs_of_second`, or `needs` if this member is
/// missing.
template <class F>
  requires requires { F::markers; }
constexpr MarkerKind needs_of_second() {
  if constexpr (requires { F::needs_of_second; })
    return F::needs_of_second;
  else
    return F::needs;
}

/// True if the markers Ms, in their order, provide the kinematics that the force element F requires.
template <class F, class... Ms>
constexpr bool tell_enough() {
  int k = 0;
  return ((Ms::observes >= (k++ == 1 ? needs_of_second<F>() : F::needs)) && ...);
}

namespace detail {
/// Refuses at compile time a force whose markers do not provide the required kinematics. \tparam enough true if every
/// marker provides them
template <bool enough>
constexpr void require_kinematics() {
  static_assert(enough,
                "This force needs a marker with a tangent or axes. A moment needs at least a tangent; a plane or an "
                "axial spring needs axes. Use a marker of another body type.");
}
}  // namespace detail

/// True if the matrix of a time step contains blocks that couple the bodies of a force element's markers. With the
/// member `static constexpr bool couples_bodies = false`, the matrix contains only the stiffness of each body. Contacts
/// with many candidates have this member: the sparsity pattern and the elimination order then do not depend on which
/// candidates touch.
template <class F>
constexpr bool couples_bodies() {
  if constexpr (requires { F::couples_bodies; })
    return F::couples_bodies;
  else
    return true;
}

/// Force element with a potential energy, a function of its frames and time [J].
template <class F>
concept HasPotential = requires(F const force, std::array<Frame<double>, F::markers> const frames, double t) {
  { force.potential(frames, t) } -> std::convertible_to<double>;
};

/// Force element with first-order states z that stores energy: its potential energy [J], a function of frames, z and
/// time, and the power −∂V/∂z · ż that its states dissipate [W].
template <class F>
concept HasStatePotential = HasStates<F> && requires(F const force, std::array<Frame<double>, F::markers> const frames,
                                                     std::array<double, states_of<F>()> const z, double t) {
  { force.potential(frames, z, t) } -> std::convertible_to<double>;
  { force.dissipation(frames, z, t) } -> std::convertible_to<double>;
};

namespace detail {

/// Dual number of `value` with the derivative `slope` in direction i.
template <int n>
Dual<n> seeded(double value, int i, double slope) {
  Dual<n> x(value);
  x.d[i] = slope;
  return x;
}
/// Computes the frame f with its derivatives with respect to pose (δr, δφ in world axes) and twist, in six directions
/// from `first` on. Derivatives with respect to the pose are multiplied by ck, those with respect to the twist by cd.
/// \param moved frame with derivatives; must be zero on entry
template <int n>
void seed_frame(Frame<double> const& f, int first, double ck, double cd, Frame<Dual<n>>& moved) {
  for (int i = 0; i < 3; ++i) {
    moved.r[i].v = f.r[i];
    moved.v[i].v = f.v[i];
    moved.w[i].v = f.w[i];
    moved.r[i].d[first + i] = ck;
    moved.v[i].d[first + i] = moved.w[i].d[first + 3 + i] = cd;
    int const j = (i + 1) % 3, l = (i + 2) % 3;
    for (int c = 0; c < 3; ++c) {  // δA = δφ × A
      moved.A(i, c).v = f.A(i, c);
      moved.A(i, c).d[first + 3 + j] = ck * f.A(l, c);
      moved.A(i, c).d[first + 3 + l] = -ck * f.A(j, c);
    }
  }
}
/// Frames of all markers with their derivatives by `seed_frame`. Marker k has the directions 6k to 6k + 5.
template <int n, std::size_t markers>
std::array<Frame<Dual<n>>, markers> seeded_frames(std::array<Frame<double>, markers> const& frames, double ck,
                                                  double cd) {
  std::array<Frame<Dual<n>>, markers> moved;
  for (std::size_t k = 0; k < markers; ++k) seed_frame(frames[k], 6 * int(k), ck, cd, moved[k]);
  return moved;
}
/// Copies the derivatives of the wrenches on N markers, 6N×n, to the first 6N rows of `gradient`.
template <int n, std::size_t markers, int rows>
void copy_slopes(std::array<Wrench<Dual<n>>, markers> const& w, Mat<double, rows, n>& gradient) {
  for (std::size_t k = 0; k < markers; ++k)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < n; ++j) {
        gradient(6 * int(k) + i, j) = w[k].f[i].d[j];
        gradient(6 * int(k) + 3 + i, j) = w[k].m[i].d[j];
      }
}

}  // namespace detail

/// Tangent of all wrenches with respect to the poses and twists of the frames, ck ∂w/∂pose + cd ∂w/∂twist (6N×6N for N
/// markers), by one evaluation with dual numbers.
template <ForceElement F>
Mat<double, 6 * F::markers, 6 * F::markers> wrench_gradient(F const& force,
                                                            std::array<Frame<double>, F::markers> const& frames,
                                                            double t, double ck, double cd) {
  constexpr int n = 6 * F::markers;
  Mat<double, n, n> gradient;
  detail::copy_slopes(force.template wrenches<Dual<n>>(detail::seeded_frames<n>(frames, ck, cd), t), gradient);
  return gradient;
}

}  // namespace polybody
