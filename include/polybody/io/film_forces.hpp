#pragma once
/// \file
/// Forces of joints and contacts as arrows of a film.

#include <polybody/io/film_scene.hpp>
#include <polybody/run/probe.hpp>

namespace polybody {

/// Adds an arrow for each joint to the last frame of a scene: the force on the joint's second body, at the second
/// marker.
/// \param unit size of the arrows' unit of force [N]: 1000 for arrows in kN
/// \throws InvalidInput and NonFiniteValue like `FilmScene::arrow`.
template <class = void>
void add_reactions(FilmScene& scene, FilmArrows arrows, ObservedState const& now, double unit = 1.0) {
  System const& system = now.evaluated();
  for (ConstraintBlock<double> const& block : system.data().rows) {
    if (block.source == ConstraintSource::body) continue;
    Index const marker = system.layout().joints[std::size_t(block.owner)].b;
    Vec3 const force = reaction_of<double>(system, now, block.owner).f;
    scene.arrow(arrows, system.data().markers[std::size_t(marker)].frame.r, force / unit);
  }
}

/// Returns a visitor for `for_each_contact` that adds an arrow for each contact point: the force on the body of the
/// contact group, not on its partner.
/// \param unit size of the arrows' unit of force [N]: 1000 for arrows in kN
template <class = void>
TouchingPointVisit add_contacts(FilmScene& scene, FilmArrows arrows, double unit = 1.0) {
  return [&scene, arrows, unit](TouchingPoint const& p) { scene.arrow(arrows, p.place, p.force / unit); };
}

}  // namespace polybody
