#pragma once
/// \file
/// A force spread along a bar, for every formulation: point forces at Gauss points.

#include <vector>

#include <polybody/forces/point_load.hpp>
#include <polybody/kinematics/marker.hpp>
#include <polybody/math/quadrature.hpp>

namespace polybody {

/// A part of a bar, measured from its first end, cut into equal pieces.
struct BarRange {
  Required<double> from, to;  ///< [m]
  Required<Index> pieces;     ///< how many equal pieces, 1 or more; each bears two point forces
};

/// Spreads `per_length` [N/m], dead or following the section, over a range of a bar, as two point forces on each piece.
/// That is exact for shapes up to third order if there are as many pieces as elements. They are called "`name`, point
/// 1" and so on, or by the next names that are free. The model's forces must hold `PointForce<Law>`. Returns their
/// handles. \throws InvalidInput for a range that is empty or outside the bar, or fewer pieces than one.
template <class M, class B, TimeLaw Law = Constant>
auto apply_distributed(M& model, BodyHandle<B> const& bar, PointForce<Law> const& per_length, BarRange const& range,
                       std::string const& name = "") {
  std::string const what = name.empty() ? "distributed force" : name;
  double const from = range.from, to = range.to;
  Index const pieces = range.pieces;
  if (!(to > from) || !std::isfinite(from) || !std::isfinite(to))
    throw InvalidInput{"\"", what, "\": a distributed force needs a range from < to, but has ", from, " to ", to, "."};
  if (pieces < 1) throw InvalidInput{"\"", what, "\": a distributed force needs at least one piece."};
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
