#pragma once
// Films of the bars of Chapter 2, with one scene for each formulation. A scene shows histories of the tip's position,
// the reaction at the support, and the axial stress of a section of 1 m x 1 m.
#include <polybody/io/film.hpp>
#include <polybody/io/film_forces.hpp>

#include "chapter2.hpp"

namespace chapter2 {

inline FilmOptions film_options(std::filesystem::path const& viewer, std::string const& title) {
  return {.viewer = viewer,
          .title = title,
          .look_from = Vec3(0.25, -0.2, 1.0),
          .up = Vec3::UnitY(),
          .floor = FilmFloor::behind};
}

// Scene of a formulation, in the colour of its body.
template <class F>
FilmScene& scene_of(Film& film, F const& formulation) {
  return film.scene(formulation.name, formulation_family<typename F::BodyType>);
}

// Observer of a run that records the frames of one scene; each call passes the model.
template <class M, class B>
class BarFilm {
 public:
  BarFilm(FilmScene& scene, BodyHandle<B> const& body, Bar const& bar) : scene_(&scene), body_(body), bar_(bar) {
    scene.colour(axial_stress_colours());
    reactions_ = scene.arrows("force of the support", "kN");
  }

  void operator()(M const& model, State const& x) {
    Vec3 const tip = position(model, x, body_.at(length));
    scene_->plot("tip x", "m", x.t, tip[0]);
    scene_->plot("tip y", "m", x.t, tip[1]);
    if (!scene_->due(x.t)) return;
    Visual visual(model);
    visual.sweep(body_, bar_, 40);
    scene_->record(visual, x);
    Probe probe(model);
    add_reactions(*scene_, reactions_, probe.at(x), 1e3);
  }

 private:
  FilmScene* scene_;
  BodyHandle<B> body_;
  Bar bar_;
  FilmArrows reactions_{};
};

}  // namespace chapter2
