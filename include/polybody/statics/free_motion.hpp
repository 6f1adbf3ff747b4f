#pragma once
/// \file
/// Rigid motions of the bodies in a null vector of the stiffness, and their description in messages.

#include <polybody/math/sequence.hpp>
#include <polybody/system/system.hpp>

namespace polybody::detail {

/// Rigid part of the motion of one body under generalised velocities z of a model.
struct RigidPart {
  Vec3 velocity = Vec3::Zero();  ///< (3) velocity of the body-fixed point at the world's origin
  Vec3 turn = Vec3::Zero();      ///< (3) angular velocity, world axes
  double left = 0.0;             ///< |velocities that no rigid motion explains| / |velocities of the body|
};

/// Computes the rigid part of the motion of `body` by least squares. The generalised velocities of its six rigid
/// motions (three in the plane) are orthogonalised one after the other.
template <class = void>  // compiled where it is used
RigidPart rigid_part(System const& system, BodyLayout const& body, VecX const& z) {
  auto const entry = require_entry(system.entries().first.rigid_velocities, "velocities of rigid motions");
  VecX all = VecX::Zero(system.layout().velocities), rest(body.velocities);
  Sequence<VecX> columns;
  Sequence<Vec6> motions;
  auto const dot = [](VecX const& a, VecX const& b) {
    double sum = 0.0;
    for (Index i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  for (Index i = 0; i < body.velocities; ++i) rest[i] = z[body.v0 + i];
  double const full = std::sqrt(dot(rest, rest));
  Vec6 found = zeros<Vec6>();
  for (int const k : {0, 1, 2, 3, 4, 5}) {
    if (body.planar && (k == 2 || k == 3 || k == 4)) continue;
    Vec6 motion = zeros<Vec6>();
    motion[k] = 1.0;
    entry(system.entries().second, system.at().q, Vec3(motion[0], motion[1], motion[2]),
          Vec3(motion[3], motion[4], motion[5]), all);
    VecX column(body.velocities);
    for (Index i = 0; i < body.velocities; ++i) column[i] = all[body.v0 + i];
    double const before = std::sqrt(dot(column, column));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      double const part = dot(columns[j], column);
      for (Index i = 0; i < column.size(); ++i) column[i] -= part * columns[j][i];
      for (int i = 0; i < 6; ++i) motion[i] -= part * motions[j][i];
    }
    double const length = std::sqrt(dot(column, column));
    if (!(length > 1e-9 * before)) continue;  // the spin of a straight cable has no velocities
    for (Index i = 0; i < column.size(); ++i) column[i] /= length;
    for (int i = 0; i < 6; ++i) motion[i] /= length;
    double const part = dot(column, rest);
    for (Index i = 0; i < column.size(); ++i) rest[i] -= part * column[i];
    for (int i = 0; i < 6; ++i) found[i] += part * motion[i];
    columns.push_back(std::move(column));
    motions.push_back(motion);
  }
  return {Vec3(found[0], found[1], found[2]), Vec3(found[3], found[4], found[5]),
          full > 0.0 ? std::sqrt(dot(rest, rest)) / full : 0.0};
}

/// Text "(0, 0, 1)" of a vector, rounded to six decimals.
template <class = void>
std::string in_brackets(Vec3 const& x) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += (i > 0 ? ", " : "(") + number(std::round(1e6 * x[i]) / 1e6 + 0.0);
  return text + ')';
}

/// Text of a rigid motion: a translation along a direction, a rotation about an axis through a point, or both. `reach`,
/// 1 + max |q|, is the size of the model.
template <class = void>
std::string text_of(RigidPart const& part, double reach) {
  double const v = std::sqrt(squared_norm(part.velocity)), w = std::sqrt(squared_norm(part.turn));
  auto const direction = [](Vec3 x) {
    double length = std::sqrt(squared_norm(x)), largest = 0.0;
    for (int i = 0; i < 3; ++i)
      if (std::abs(x[i]) > (1.0 + 1e-6) * std::abs(largest)) largest = x[i];
    if (largest < 0.0) length = -length;
    for (int i = 0; i < 3; ++i) x[i] /= length;
    return x;
  };
  if (part.left > 1e-5 || !(v + w > 0.0)) return "changes its shape";
  if (w * reach <= 1e-6 * v) return sentence_of({"moves along ", in_brackets(direction(part.velocity))});
  Vec3 const axis = direction(part.turn), lever = part.turn.cross(part.velocity);
  Vec3 point;
  for (int i = 0; i < 3; ++i) point[i] = lever[i] / (w * w);
  std::string text = sentence_of({"turns about ", in_brackets(axis), " through ", in_brackets(point)});
  double along = 0.0;
  for (int i = 0; i < 3; ++i) along += axis[i] * part.velocity[i];
  if (std::abs(along) > 1e-6 * (v + w * reach)) text += " and moves along it";
  return text;
}

/// Text of the motion z of a model, with the name of the body of unknown i. Example: body "payload" turns about (0, 0,
/// 1) through (0, 0, -2).
template <class = void>
std::string name_of_motion(System const& system, VecX const& z, Index i) {
  std::string text = system.name_of(i);
  if (system.step_coordinates() || system.entries().first.rigid_velocities == nullptr) return text;
  double const reach = 1.0 + largest_size(system.at().q);
  int others = 0;
  double largest = 0.0;
  for (Index k = 0; k < system.velocities(); ++k) largest = std::max(largest, std::abs(z[k]));
  for (BodyLayout const& body : system.layout().bodies) {
    bool moves = false;
    for (Index k = body.v0; k < body.v0 + body.velocities; ++k) moves = moves || std::abs(z[k]) > 1e-6 * largest;
    if (i >= body.v0 && i < body.v0 + body.velocities)
      text += ' ' + text_of(rigid_part(system, body, z), reach);
    else if (moves)
      ++others;
  }
  if (others > 0) text += sentence_of({", and ", others, (others > 1 ? " other bodies" : " other body"), " with it"});
  return text;
}

}  // namespace polybody::detail
