#pragma once
/// \file
/// Scene of a film: the frames of a run, with arrows and histories.

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>

#include <polybody/io/film_bytes.hpp>
#include <polybody/io/visual.hpp>

namespace polybody {

/// Scalar field on the points of a part, shown by colours with a colour bar.
struct FilmScalar {
  std::string label;  ///< text at the colour bar
  std::string unit;   ///< unit of the values
  /// Returns one value in `unit` for each point of a part, or an empty list for a part without values. A value may be
  /// NaN.
  std::function<std::vector<double>(VisualPart const&)> values;
};

/// Colour scalar: axial stress of bodies that provide stresses [MPa].
template <class = void>
FilmScalar axial_stress_colours() {
  return {"axial stress", "MPa", [](VisualPart const& part) {
            std::vector<double> values = part.axial_stress;
            for (double& s : values) s *= 1e-6;
            return values;
          }};
}

/// Colour scalar: magnitude of the velocity of each point [m/s].
template <class = void>
FilmScalar speed_colours() {
  return {"speed", "m/s", [](VisualPart const& part) {
            std::vector<double> values;
            for (Vec3 const& v : part.velocities) values.push_back(v.norm());
            return values;
          }};
}

namespace detail {

/// Motion of a part: origin and rotation of the part's axes in each frame of the film, and deviations of its points. A
/// deviation is the change of a point's position since the first frame of the film, in the part's axes.
struct FilmPart {
  std::string name;
  std::size_t shape = 0;  ///< index of the shape in the scene
  bool rigid = false;
  std::vector<Vec3> points = {};            ///< positions in the first frame of the film, part's axes, as float32 [m]
  std::vector<float> places = {};           ///< origins, 3 numbers per frame [m]
  std::vector<std::int16_t> turns = {};     ///< quaternions, 4 numbers per frame
  std::vector<float> deviations = {};       ///< 3 numbers per point and frame [m]
  std::vector<std::vector<float>> scalars;  ///< for each scalar of the scene: 1 number per point and frame, or none
};

/// Shape of a part: points in the part's axes, and the polygons through them.
struct FilmShape {
  std::vector<float> points;
  std::vector<int> corners, ends;
  bool operator==(FilmShape const&) const = default;
};

struct FilmArrowSet {
  std::string label, unit;
  bool visible = true;
  std::vector<std::uint32_t> counts = {};  ///< number of arrows in each frame
  std::vector<float> places = {}, vectors = {};
};

struct FilmHistory {
  std::string label, unit;
  std::vector<double> times = {};
  std::vector<float> values = {};
};

}  // namespace detail

/// Handle of a set of arrows, returned by `FilmScene::arrows`.
struct FilmArrows {
  std::size_t place;  ///< index of the set in the scene
};

/// Scene of a film, created by `Film::scene`. Colours and sets of arrows are defined before the first frame:
///   scene.colour(axial_stress_colours());
///   FilmArrows const contacts = scene.arrows("contact forces", "N");
///   for (State const& now : simulate(…)) {
///     scene.plot("pin force", "N", now.t, force);
///     if (!scene.due(now.t)) continue;
///     scene.record(visual, now);
///     scene.arrow(contacts, place, force);
///   }
class FilmScene {
 public:
  /// Scene without frames, with this number of `frames_per_second` [1/s]. Programs call `Film::scene` instead.
  /// \param colour colour of the formulation, see `formulation_colour`; −1: none
  FilmScene(std::string name, double frames_per_second, int colour = -1)
      : name_(std::move(name)), interval_(1.0 / frames_per_second), preferred_colour_(colour) {}

  /// Adds a scalar that colours the parts.
  /// \throws InvalidInput after the first frame, or if the scene already has a scalar with this label.
  void colour(FilmScalar scalar) {
    require_start(scalar.label);
    for (FilmScalar const& other : scalars_)
      if (other.label == scalar.label)
        throw InvalidInput("film.scene",
                           {ErrorObject{who()}, "the scene already has a colour scalar \"", scalar.label, "\"."});
    scalars_.push_back(std::move(scalar));
  }

  /// Adds a set of arrows with this `label`. All vectors of the set have this `unit`, and the same scale in the
  /// picture.
  /// \param visible initial visibility in the viewer
  /// \throws InvalidInput after the first frame.
  FilmArrows arrows(std::string label, std::string unit, bool visible = true) {
    require_start(label);
    arrows_.push_back({std::move(label), std::move(unit), visible});
    return {arrows_.size() - 1};
  }

  /// Returns true if a frame is due at time t [s] according to the film's frames per second.
  bool due(double t) const { return times_.empty() || t >= next_ - 1e-9; }

  /// Records a frame of `parts` at time t [s].
  /// \throws InvalidInput if there are no parts, if t does not exceed the time of the last frame, if the parts differ
  /// from those of the first frame, or if a scalar has another number of values than a part has points.
  /// \throws NonFiniteValue for a time or part that is not finite.
  void record(double t, std::vector<VisualPart> const& parts) {
    if (!std::isfinite(t))
      throw NonFiniteValue("film.not_finite",
                           {ErrorObject{who()}, "the time of a frame must be finite, but is ", ErrorTime{t}, " s."});
    if (!times_.empty() && !(t > times_.back()))
      throw InvalidInput("film.time_order", {ErrorObject{who()}, "the times of the frames must increase, but t = ",
                                             ErrorTime{t}, " s follows ", times_.back(), " s."});
    if (parts.empty())
      throw InvalidInput("film.scene",
                         {ErrorObject{who()}, "the frame has no parts. Add shapes to the Visual by attach or sweep."});
    check_parts(t, parts);
    if (times_.empty()) {
      for (VisualPart const& part : parts) add_part(part);
      auto const in = [&](World world) { return std::ranges::count(parts, world, &VisualPart::world) > 0; };
      planar_ = in(World::plane) && !in(World::space);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) add_frame(t, parts[i], parts_[i]);
    for (detail::FilmArrowSet& set : arrows_) set.counts.push_back(0);
    if (times_.empty()) next_ = t;
    times_.push_back(t);
    next_ = next_ + interval_ > t ? next_ + interval_ : t + interval_;
  }

  /// Records a frame of `visual` in state x. The film lists the bodies that have no shape.
  template <class = void>
  void record(Visual& visual, State const& x) {
    if (times_.empty()) invisible_ = visual.bodies_without_shape();
    record(x.t, visual.at(x));
  }

  /// Adds an arrow to the last frame.
  /// \param place start of the arrow, world axes [m]
  /// \param vector the arrow, world axes [unit of the set]
  /// \throws InvalidInput if there is no frame yet, or for arrows of another scene; NonFiniteValue if `place` or
  /// `vector` is not finite.
  void arrow(FilmArrows set, Vec3 const& place, Vec3 const& vector) {
    if (set.place >= arrows_.size() || times_.empty())
      throw InvalidInput("film.arrow", {ErrorObject{who()},
                                        "an arrow needs a recorded frame, and a set of arrows of this scene. Record a "
                                        "frame first, and use FilmArrows that this scene returned."});
    detail::FilmArrowSet& arrows = arrows_[set.place];
    if (!place.allFinite() || !vector.allFinite())
      throw NonFiniteValue("film.not_finite", {ErrorObject{who()}, "an arrow of \"", arrows.label,
                                               "\" is not finite at t = ", ErrorTime{times_.back()}, " s."});
    ++arrows.counts.back();
    for (int i = 0; i < 3; ++i) arrows.places.push_back(float(place[i])), arrows.vectors.push_back(float(vector[i]));
  }

  /// Adds a point to the history `label`: a `value` in `unit` at time t [s]. Histories of several scenes with the same
  /// label share a plot.
  /// \throws InvalidInput unless the times of the history increase and its unit is that of the first point;
  /// NonFiniteValue if t or `value` is not finite.
  void plot(std::string const& label, std::string const& unit, double t, double value) {
    if (!std::isfinite(t) || !std::isfinite(value))
      throw NonFiniteValue("film.not_finite", {ErrorObject{who()}, "a point of the history \"", label,
                                               "\" is not finite at t = ", ErrorTime{t}, " s."});
    auto found = std::find_if(histories_.begin(), histories_.end(), [&](auto const& h) { return h.label == label; });
    if (found == histories_.end()) found = histories_.insert(found, {label, unit});
    if (found->unit != unit)
      throw InvalidInput("film.unit", {ErrorObject{who()}, "the history \"", label, "\" has the unit \"", found->unit,
                                       "\", but a further point has \"", unit, "\". Use one unit in a history."});
    if (!found->times.empty() && !(t > found->times.back()))
      throw InvalidInput("film.time_order",
                         {ErrorObject{who()}, "the times of the history \"", label,
                          "\" must increase, but t = ", ErrorTime{t}, " s follows ", found->times.back(), " s."});
    found->times.push_back(t);
    found->values.push_back(float(value));
  }

  std::string const& name() const { return name_; }            ///< name given to `Film::scene`
  std::vector<double> const& times() const { return times_; }  ///< times of the frames [s]
  int preferred_colour() const { return preferred_colour_; }   ///< index of the formulation's colour; −1: none
  bool planar() const { return planar_; }                      ///< true if all bodies with a shape are planar
  /// Names of the bodies without a shape, if the first frame is that of a `Visual`.
  std::vector<std::string> const& invisible() const { return invisible_; }

  /// \name Data that a film writes
  ///@{
  std::vector<FilmScalar> const& scalars() const { return scalars_; }              ///< scalars that colour the parts
  std::vector<detail::FilmShape> const& shapes() const { return shapes_; }         ///< different shapes of the parts
  std::vector<detail::FilmPart> const& parts() const { return parts_; }            ///< parts with all their frames
  std::vector<detail::FilmArrowSet> const& arrow_sets() const { return arrows_; }  ///< sets of arrows
  std::vector<detail::FilmHistory> const& histories() const {
    return histories_;
  }  ///< histories in the order of their first points
     ///@}

 private:
  std::string who() const { return "Film, scene \"" + name_ + "\": "; }

  void require_start(std::string const& what) const {
    if (!times_.empty())
      throw InvalidInput("film.late", {ErrorObject{who()}, "\"", what, "\" must be defined before the first frame."});
  }

  void check_parts(double t, std::vector<VisualPart> const& parts) const {
    bool same = times_.empty() || parts.size() == parts_.size();
    for (std::size_t i = 0; same && i < parts.size(); ++i) {
      VisualPart const& part = parts[i];
      for (Vec3 const& p : part.surface.points)
        if (!p.allFinite())
          throw NonFiniteValue("film.not_finite", {ErrorObject{who()}, "a point of \"", part.name,
                                                   "\" is not finite at t = ", ErrorTime{t}, " s."});
      if (!part.place.allFinite() || !part.axes.allFinite())
        throw NonFiniteValue("film.not_finite", {ErrorObject{who()}, "the frame of \"", part.name,
                                                 "\" is not finite at t = ", ErrorTime{t}, " s."});
      same = times_.empty() || (part.name == parts_[i].name && part.surface.points.size() == parts_[i].points.size());
    }
    if (!same)
      throw InvalidInput("film.parts", {ErrorObject{who()}, "the parts at t = ", ErrorTime{t},
                                        " s differ from the parts of the first frame."});
  }

  void add_part(VisualPart const& part) {
    bool const rigid = !part.carried.empty();
    detail::FilmShape shape{.points = {}, .corners = part.surface.corners, .ends = part.surface.ends};
    Mat3 const axes = detail::rotation_of(detail::quantised_rotation(part.axes));
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < part.surface.points.size(); ++i) {
      Vec3 const p = rigid ? part.carried[i] : Vec3(axes.transpose() * (part.surface.points[i] - part.place));
      for (int k = 0; k < 3; ++k) shape.points.push_back(float(p[k]));
      points.emplace_back(p.cast<float>().cast<double>());
    }
    std::size_t k = 0;
    while (k < shapes_.size() && !(shapes_[k] == shape)) ++k;
    if (k == shapes_.size()) shapes_.push_back(std::move(shape));
    parts_.push_back({.name = part.name,
                      .shape = k,
                      .rigid = rigid,
                      .points = std::move(points),
                      .scalars = std::vector<std::vector<float>>(scalars_.size())});
  }

  void add_frame(double t, VisualPart const& part, detail::FilmPart& out) const {
    auto const turn = detail::quantised_rotation(part.axes);
    Mat3 const axes = detail::rotation_of(turn);
    out.turns.insert(out.turns.end(), turn.begin(), turn.end());
    Vec3 const place = part.place.cast<float>().cast<double>();
    for (int k = 0; k < 3; ++k) out.places.push_back(float(place[k]));
    if (!out.rigid)
      for (std::size_t i = 0; i < out.points.size(); ++i) {
        Vec3 const off = axes.transpose() * (part.surface.points[i] - place) - out.points[i];
        for (int k = 0; k < 3; ++k) out.deviations.push_back(float(off[k]));
      }
    for (std::size_t s = 0; s < scalars_.size(); ++s) {
      std::vector<double> const values = scalars_[s].values(part);
      std::size_t const before = out.scalars[s].size(), wanted = times_.size() * out.points.size();
      bool const fits = values.empty() ? before == 0 : before == wanted && values.size() == out.points.size();
      if (!fits)
        throw InvalidInput("film.parts",
                           {ErrorObject{who()}, "the number of values of \"", scalars_[s].label, "\" on \"", part.name,
                            "\" differs from the number of points at t = ", ErrorTime{t}, " s."});
      for (double const x : values) out.scalars[s].push_back(float(x));
    }
  }

  std::string name_;
  double interval_, next_ = -std::numeric_limits<double>::infinity();
  int preferred_colour_;
  bool planar_ = false;
  std::vector<std::string> invisible_;
  std::vector<double> times_;
  std::vector<FilmScalar> scalars_;
  std::vector<detail::FilmShape> shapes_;
  std::vector<detail::FilmPart> parts_;
  std::vector<detail::FilmArrowSet> arrows_;
  std::vector<detail::FilmHistory> histories_;
};

}  // namespace polybody
