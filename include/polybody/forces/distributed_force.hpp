#pragma once
/// \file
/// Distributed force along a bar of any formulation, by point forces at Gauss points.

#include <vector>

#include <polybody/forces/point_load.hpp>
#include <polybody/kinematics/marker.hpp>
#include <polybody/math/quadrature.hpp>

namespace polybody {

/// Range of a bar, measured from its first end and divided into equal pieces.
struct BarRange {
  Required<double> from, to;  ///< start and end of the range [m]
  Required<Index> pieces;     ///< number of equal pieces, at least 1, with two point forces each
};

/// Applies the distributed force `per_length` [N/m], a dead or follower load, to a range of a bar as two point forces
/// on each piece. For a dead load, the generalised forces are exact for shape functions up to third order if each
/// element has its own piece. The forces are named "`name`, point 1" and so on; without a name, the model names them.
/// The force types of the model must include `PointForce<Law>`. Returns the handles of the forces.
/// \throws InvalidInput for a range that is empty or outside the bar, or for less than one piece.
template <class M, class B, TimeFunction Law = Constant>
auto apply_distributed(M& model, BodyHandle<B> const& bar, PointForce<Law> const& per_length, BarRange const& range,
                       std::string const& name = "") {
  std::string const what = name.empty() ? "distributed force" : name;
  double const from = range.from, to = range.to;
  Index const pieces = range.pieces;
  if (!(to > from) || !std::isfinite(from) || !std::isfinite(to))
    throw InvalidInput("distributed_force.range",
                       {"\"", ErrorObject{what}, "\": a distributed force needs a range from < to, but has from = ",
                        from, " m, to = ", to, " m."});
  if (pieces < 1)
    throw InvalidInput("distributed_force.pieces",
                       {"\"", ErrorObject{what}, "\": a distributed force needs at least one piece, but has ",
                        ErrorValue{pieces}, "."});
  double const l = (to - from) / double(pieces);
  std::vector<decltype(model.apply(per_length, bar.at(from), name))> handles;
  for (Index i = 0; i < pieces; ++i)
    for (auto const& g : gauss<2>) {
      PointForce<Law> part = per_length;
      part.force *= g.weight * l;
      std::string const own = name.empty() ? "" : name + ", point " + std::to_string(handles.size() + 1);
      handles.push_back(model.apply(part, bar.at(from + (double(i) + g.xi) * l), own));
    }
  return handles;
}

}  // namespace polybody
