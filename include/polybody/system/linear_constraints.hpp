#pragma once
/// \file
/// Constraint equations of linear joints, Φ = C_a e_a + C_b e_b − c, with the coordinates e_a, e_b of the two bodies
/// and constant C [thesis §3.5.4].
/// Theory: Eq. 5.13.

#include <string>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/composition.hpp>

namespace polybody {

/// Terms of one body in linear constraint equations.
struct LinearSide {
  Index q0 = 0, v0 = 0;  ///< indices of the first coordinate and generalised velocity of the columns
  MatX map;              ///< (rows × columns) C; no columns for the ground
};

/// Linear constraint equations of one joint: first the position equations, then the gradient equations.
struct LinearConstraints {
  std::string name;           ///< name of the joint in messages
  Index row = 0;              ///< index of its first equation in the model
  LinearSide a = {}, b = {};  ///< bodies of the two markers
  VecX constant = {};         ///< (rows) c
  Index positions = 0;        ///< number of position equations
  /// Equations that equate one position gradient of a and b, or its component along an axis.
  struct Gradient {
    Index rows;  ///< number of these equations
    MatX map;    ///< map of the gradient of b, or of a if b is the ground
    Vec3 axis;   ///< (3) unit vector in world axes, used for a single equation
  };
  Sequence<Gradient> gradients = {};  ///< gradients in the order of their equations
  /// Number of equations of the joint.
  Index rows() const { return constant.size(); }
};

namespace detail {

/// Linear maps of the position and the gradients of a point, with their values in the reference configuration.
template <class T>
struct LinearPointOf {
  using Vec3 = Vec<T, 3>;
  using Mat3 = Mat<T, 3, 3>;
  using MatX = MatXOf<T>;

  int size = 3;  ///< number of components: three, or two in the plane
  Index columns = 0;
  MatX position;  ///< (size × columns)
  std::array<MatX, 3> gradients;
  int gradient_count = 0;  ///< number of gradients; the ground has three, without columns
  Vec3 at = Vec3::Zero();  ///< r in the reference configuration
  Mat3 J = identity();     ///< [r_x r_y r_z] in the reference configuration; unit vectors for missing gradients

  bool complete() const { return gradient_count == 3; }
  /// Map of J J₀⁻¹ w, the current direction of the material line that has direction w in the reference configuration.
  /// For a body with incomplete gradients, returns the map of its first gradient for every w.
  MatX carried(Vec3 const& w) const {
    if (columns == 0) return MatX(size, 0);
    if (!complete()) return gradients[0];
    Vec3 const material = J.inverse() * w;
    MatX map = MatX::Zero(size, columns);
    for (int k = 0; k < 3; ++k) map += material[k] * gradients[std::size_t(k)];
    return map;
  }
};
using LinearPoint = LinearPointOf<double>;

template <HasLinearPoints B, class T = double>
LinearPointOf<T> linear_point(B const& body, typename B::Point const& p) {
  LinearPointOf<T> out;
  out.size = B::world == World::plane ? 2 : 3;
  Sequence<double> reference(std::size_t(body.coordinates()));
  body.reference(reference);
  auto const position = body.position_map(p);
  out.columns = position.cols();
  Eigen::Map<VecXOf<T> const> const e(reference.data() + body.first_column(p), out.columns);
  out.position = position;
  out.at.head(out.size) = out.position * e;
  out.gradient_count = B::gradients;
  if constexpr (B::gradients > 0)
    for (int k = 0; k < B::gradients; ++k) {
      out.gradients[std::size_t(k)] = body.gradient_map(p, k);
      out.J.col(k).head(out.size) = out.gradients[std::size_t(k)] * e;
    }
  return out;
}

template <class T = double>
LinearPointOf<T> linear_ground(Placement const& placement, int size) {
  LinearPointOf<T> out;
  out.size = size;
  out.position.resize(size, 0);
  out.gradient_count = 3;
  out.at = placement.origin;
  return out;
}

/// Appends Φ = (C_b e_b) − (C_a e_a) − c.
template <class T>
void append_rows(LinearConstraints& rows, MatXOf<T> const& a, MatXOf<T> const& b, VecXOf<T> const& c) {
  auto const append = [](auto& to, T sign, auto const& more) {
    Index const before = to.rows();
    to.conservativeResize(before + more.rows(), more.cols());
    for (Index j = 0; j < more.cols(); ++j)
      for (Index i = 0; i < more.rows(); ++i) to(before + i, j) = sign * more(i, j);
  };
  append(rows.a.map, -1.0, a);
  append(rows.b.map, 1.0, b);
  append(rows.constant, 1.0, c);
}

/// Appends to `rows` the constraint equations of geometry G, with its third axis along n, between two linear points.
/// \throws InvalidInput if the equations are not linear; the message names the joint.
template <LinearGeometry G, class T>
void fill_linear_rows(LinearPointOf<T> const& a, LinearPointOf<T> const& b, std::type_identity_t<Vec<T, 3>> const& n,
                      LinearConstraints& rows) {
  using V = Vec<T, 3>;
  using Vx = VecXOf<T>;
  using Mx = MatXOf<T>;
  constexpr int turns = free_turns(free_directions<G>());
  int const size = b.size;
  rows.a.map.resize(0, a.columns);
  rows.b.map.resize(0, b.columns);
  // c is the constant part of r_a − r_b. Only ground points have a constant part: they depend on no coordinates.
  V const still = (a.columns == 0 ? a.at : V(V::Zero())) - (b.columns == 0 ? b.at : V(V::Zero()));
  append_rows<T>(rows, a.position, b.position, still.head(size));
  rows.positions = size;
  if constexpr (turns == 3 || (turns == 1 && G::world == World::plane)) return;
  auto const share = [&](V const& of_a, V const& of_b, bool along_axis_only) {
    Mx ca = a.carried(of_a), cb = b.carried(of_b);
    Vx c = ((a.columns == 0 ? of_a : V(V::Zero())) - (b.columns == 0 ? of_b : V(V::Zero()))).head(size);
    rows.gradients.push_back({along_axis_only ? 1 : Index(size), b.columns > 0 ? cb : ca, n});
    if (along_axis_only) {
      Mat<T, 1, Eigen::Dynamic> const axis = n.head(size).transpose();
      ca = (axis * ca).eval();
      cb = (axis * cb).eval();
      c = Vx::Constant(1, axis * c);
    }
    append_rows<T>(rows, ca, cb, c);
  };
  if constexpr (turns == 1) {
    if (a.complete() && b.complete()) {
      share(n, n, false);
    } else {
      V const t_a = a.complete() ? b.J.col(0) : a.J.col(0), t_b = b.complete() ? a.J.col(0) : b.J.col(0);
      if (std::abs(n.dot(t_a)) > 1e-9 || std::abs(n.dot(t_b)) > 1e-9)
        throw InvalidInput(
            "ancf_linear.pin_axis",
            {"\"", ErrorObject{rows.name},
             "\": the axis of a pin must be perpendicular to the cable, but the cosine of the angle "
             "between axis and cable is ",
             ErrorValue{std::max(std::abs(n.dot(t_a)), std::abs(n.dot(t_b)))}, ". Change the axis of the joint."});
      share(t_a, t_b, true);
    }
  } else if (a.complete() && b.complete()) {
    for (int k = 0; k < size; ++k) share(V::Unit(k), V::Unit(k), false);
  } else if (a.gradient_count == 0 || b.gradient_count == 0) {
    throw InvalidInput("ancf_linear.weld",
                       {"\"", ErrorObject{rows.name},
                        "\": AncfLinear welds only bodies with position gradients. Use Constraint here."});
  } else {
    V const t = a.complete() ? b.J.col(0) : a.J.col(0);
    if (!a.complete() && !b.complete() && (a.J.col(0) - b.J.col(0)).norm() > 1e-9)
      throw InvalidInput(
          "ancf_linear.weld",
          {"\"", ErrorObject{rows.name},
           "\": AncfLinear welds two cables only if their tangents agree. Use Constraint for a corner."});
    share(t, t, false);
  }
}

}  // namespace detail
}  // namespace polybody
