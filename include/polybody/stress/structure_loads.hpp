#pragma once
/// \file
/// Loads of a recorded rigid motion on a structure.
/// Theory: Eqs. 11.18, 11.19.

#include <algorithm>

#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/bodies/ffr/node_patch.hpp>
#include <polybody/run/body_record.hpp>

namespace polybody {

/// Patch of nodes that share a load.
struct LoadPatch {
  Vec3 at;          ///< (3) point of action in the structure's axes [m]
  NodePatch nodes;  ///< nodes that share the load
};

/// Options for the loads of a recorded motion on a structure.
struct StructureLoadOptions {
  /// Placement of the structure's axes relative to the body's axes. Empty: the axes are parallel and the centres of
  /// mass coincide, as for a body and a structure made from the same bar.
  std::optional<Placement> placement = {};
  double largest_gap = 0.0;  ///< largest interpolated interval between samples [s]; 0: 1.5 times the median interval
  double balance_tolerance = 1e-3;  ///< allowed unbalanced force and moment, relative to the sum of the magnitudes
  /// Nodes within this distance of a load share it [m]. Required for loads on nodes without rotations, except loads at
  /// the points of `patches`.
  double patch = 0.0;
  /// Nodes that share the load at the point `at`; only for nodes without rotations.
  std::vector<LoadPatch> patches = {};
};

/// Loads of a recorded motion on a structure: nodal forces of joints, contacts, gravity and of the inertia of the
/// body's rigid motion [Wallin 2016, §4.3.2–4.3.5]. In the structure's axes a point u₀ of the body has the acceleration
/// minus gravity
///   a(u₀) = b + B u₀,   b = Aᵀ(r̈ − g),   B = Ω˙~ + Ω~ Ω~.
/// A is the rotation matrix, r̈ the acceleration of the structure's origin, g gravity, and Ω the angular velocity. x~ is
/// the skew-symmetric matrix of x. The linear structural problem has the right-hand side
///   Q_f − m_fr q̈_r − C_qfᵀ λ = −∫ρ Sᵀ a + Σ (Sᵀ f + S_rᵀ m),   ∫ρ Sᵀ a = Σ_l b_l ∫ρ S_lᵀ + Σ_kl B_lk ∫ρ u₀ₖ S_lᵀ.
/// In Wallin 2016, the term Ω~ Ω~ of B is the reduced (Q_v)_f = Ĩ₀ω of Eq. 4.2 and A.4c, and Ω˙~ is the rotational part
/// of m_fr. S and S_r are the matrices of Eq. 4.5.
class StructureLoads {
 public:
  /// Motion of the structure at one sample, in the structure's axes.
  struct Motion {
    Vec3 b = Vec3::Zero();      ///< acceleration of the origin minus gravity [m/s²]
    Vec3 omega = Vec3::Zero();  ///< Ω, angular velocity [rad/s]
    Mat3 B = Mat3::Zero();      ///< Ω˙~ + Ω~ Ω~, gradient of the acceleration [1/s²]
    double size = 0.0;          ///< |r̈| + |g|, the size of the terms in b [m/s²]
  };
  /// Wrench in the structure's axes about its point of action, on a beam or a node.
  struct Load {
    Index beam = -1, node = -1;               ///< beam or node with the point of action; −1: none
    double xi = 0.0;                          ///< ξ along the beam, 0 … 1
    Vec3 f = Vec3::Zero(), m = Vec3::Zero();  ///< (3) force [N] and moment [N m]
  };

  /// Computes the loads of a `record` on a `structure`. \throws InvalidInput for fewer than two samples, gaps in the
  /// record, loads that do not balance the structure's inertia, and patches of nodes that cannot carry their load.
  /// \throws NonFiniteValue if the recorded motion is not finite.
  template <class = void>  // compiled where it is used
  StructureLoads(Structure structure, BodyRecord const& record, StructureLoadOptions const& options)
      : s_(std::move(structure)),
        name_(record.name),
        patch_of_(sentence_of({"Stress of \"", name_, "\", nodes within ", options.patch, " m of a load"})) {
    require_positive(s_.mass, who() + "the structure's mass");
    require_positive(options.balance_tolerance, who() + "the balance tolerance");
    require_not_negative(options.patch, who() + "the patch");
    require_no_gaps(record, options.largest_gap, who());
    Placement place{.origin = -s_.first / s_.mass};
    if (options.placement) place = *options.placement;
    place.check(who() + "the structure");
    for (BodySample const& sample : record.samples) {
      times_.push_back(sample.t);
      motions_.push_back(motion(sample, record.gravity, place));
      loads_.emplace_back();
      for (LoadSample const& l : sample.loads) {
        Load load{.f = place.axes.transpose() * l.f, .m = place.axes.transpose() * l.m};
        Vec3 const at = place.axes.transpose() * (l.at - place.origin);
        if (s_.per_node == 3)
          share(load, at, options);
        else
          take(load, at);
      }
    }
    require_balance(options.balance_tolerance);
  }

  std::string const& name() const { return name_; }                          ///< name of the body
  Structure const& structure() const { return s_; }                          ///< finite element model under load
  std::vector<double> const& times() const { return times_; }                ///< times of the samples [s]
  Motion const& motion(std::size_t k) const { return motions_[k]; }          ///< motion of sample k
  std::vector<Load> const& loads(std::size_t k) const { return loads_[k]; }  ///< loads of sample k

  /// Nodal forces of sample k (N×1, for N nodal coordinates).
  template <class = void>
  VecX nodal(std::size_t k) const {
    Motion const& at = motions_[k];
    VecX q = VecX::Zero(s_.size());
    for (std::size_t l = 0; l < 3; ++l) {
      q -= at.b[Index(l)] * s_.translation[l];
      for (std::size_t i = 0; i < 3; ++i) q -= at.B(Index(l), Index(i)) * s_.moment[i][l];
    }
    for (Load const& load : loads_[k])
      if (load.beam >= 0) {
        add_entries(beam(load), on_beam(load), q);
      } else {
        q.segment<3>(s_.per_node * load.node) += load.f;
        if (s_.per_node == 6) q.segment<3>(6 * load.node + 3) += load.m;
      }
    return q;
  }

  /// Nodal forces of all samples (N×samples).
  template <class = void>
  MatX nodal() const {
    MatX q(s_.size(), Index(times_.size()));
    for (std::size_t k = 0; k < times_.size(); ++k) q.col(Index(k)) = nodal(k);
    return q;
  }

  /// Nodal forces (12) of a load on its beam.
  template <class = void>
  Vec<double, 12> on_beam(Load const& load) const {
    BeamShapes const shapes(load.xi, beam(load));
    Mat3 const& axes = beam(load).axes;
    return in_body_axes(shapes.axis, axes).transpose() * load.f +
           in_body_axes(shapes.rotation, axes).transpose() * load.m;
  }
  /// Beam under a load; undefined for a load on a node.
  Structure::Beam const& beam(Load const& load) const { return s_.beams[std::size_t(load.beam)]; }

 private:
  std::string who() const { return sentence_of({"Stress of \"", name_, "\": "}); }

  template <class = void>
  Motion motion(BodySample const& sample, Vec3 const& gravity, Placement const& place) const {
    Mat3 const axes = sample.frame.A * place.axes;
    Motion x;
    x.omega = axes.transpose() * sample.frame.w;
    Vec3 const alpha = axes.transpose() * sample.angular_acceleration;
    x.B = skew<double>(alpha) + skew<double>(x.omega) * skew<double>(x.omega);
    x.b = axes.transpose() * (sample.acceleration - gravity) + x.B * (place.axes.transpose() * place.origin);
    x.size = sample.acceleration.norm() + gravity.norm();
    if (!x.b.allFinite() || !x.B.allFinite())
      throw NonFiniteValue(
          "stress.motion_not_finite",
          {ErrorObject{who()}, "the recorded motion at t = ", ErrorTime{sample.t}, " s is not finite."});
    return x;
  }

  /// Applies a load to the nearest section of a beam, or to the nearest node if there are no beams. The section is
  /// rigid.
  template <class = void>
  void take(Load load, Vec3 const& at) {
    Vec3 held = Vec3::Zero();
    double least = std::numeric_limits<double>::infinity();
    auto const nearer = [&](Vec3 const& r) {
      double const distance = (r - at).norm();
      if (!(distance < least)) return false;
      least = distance;
      held = r;
      return true;
    };
    for (std::size_t i = 0; i < s_.beams.size(); ++i) {
      Structure::Beam const& b = s_.beams[i];
      Vec3 const start = s_.nodes[std::size_t(b.a)], along = b.axes.col(0);
      double const xi = std::clamp((at - start).dot(along) / b.length, 0.0, 1.0);
      if (nearer(start + along * (xi * b.length))) {
        load.beam = Index(i);
        load.xi = xi;
      }
    }
    if (s_.beams.empty())
      for (std::size_t i = 0; i < s_.nodes.size(); ++i)
        if (nearer(s_.nodes[i])) load.node = Index(i);
    load.m += (at - held).cross(load.f);
    loads_.back().push_back(load);
  }

  /// Distributes a load among the nodes of a patch.
  template <class = void>
  void share(Load const& load, Vec3 const& at, StructureLoadOptions const& options) {
    auto const own = std::find_if(options.patches.begin(), options.patches.end(),
                                  [&](LoadPatch const& p) { return (p.at - at).norm() <= same_place; });
    if (own != options.patches.end()) return spread(load, at, own->nodes);
    spread(load, at, NodePatch(s_, nodes_within(s_, at, options.patch), patch_of_));
  }
  template <class = void>
  void spread(Load const& load, Vec3 const& at, NodePatch const& patch) {
    for (std::size_t k = 0; k < patch.nodes().size(); ++k)
      loads_.back().push_back({.node = patch.nodes()[k], .f = patch.force(k, at, load.f, load.m), .m = Vec3::Zero()});
  }

  template <class = void>
  double size() const {
    double most = 0.0;
    for (Vec3 const& r : s_.nodes) most = std::max(most, (r - s_.nodes.front()).norm());
    return most;
  }

  /// Checks Σ f − ∫ρ a = 0 and Σ (m + u × f) − ∫ρ u × a = 0 about the centre of mass, relative to the largest sum of
  /// absolute values in the record.
  template <class = void>
  void require_balance(double part) const {
    double const length = size();
    Vec3 const centre = s_.first / s_.mass;
    Mat3 const second = s_.second - s_.mass * centre * centre.transpose();
    double worst = 0.0, most = 0.0, when = 0.0;
    for (std::size_t k = 0; k < times_.size(); ++k) {
      Motion const& at = motions_[k];
      Mat3 const turn = at.B * second;
      Vec3 const inertia = s_.mass * (at.b + at.B * centre),
                 spin(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
      Vec3 force = -inertia, moment = -spin;
      double total = s_.mass * at.size + turn.norm() / length;
      for (Load const& l : loads_[k]) {
        Vec3 const u =
            (l.beam < 0 ? s_.nodes[std::size_t(l.node)]
                        : Vec3(s_.nodes[std::size_t(beam(l).a)] + beam(l).axes.col(0) * (l.xi * beam(l).length))) -
            centre;
        force += l.f;
        moment += l.m + u.cross(l.f);
        total += l.f.norm() + l.m.norm() / length;
      }
      most = std::max(most, total);
      if (double const left = force.norm() + moment.norm() / length; left > worst) {
        worst = left;
        when = times_[k];
      }
    }
    if (worst > part * most)
      throw InvalidInput("stress.unbalanced",
                         {ErrorObject{who()}, "the recorded loads do not balance the inertia of the structure: ",
                          ErrorValue{worst}, " N of ", most, " N remain at t = ", ErrorTime{when},
                          " s. Give the structure the mass, inertia and placement of the recorded body, or raise "
                          "`balance_tolerance`."});
  }

  static constexpr double same_place = 1e-6;  ///< largest distance between a load and its patch [m]

  Structure s_;
  std::string name_, patch_of_;
  std::vector<double> times_;
  std::vector<Motion> motions_;
  std::vector<std::vector<Load>> loads_;
};

}  // namespace polybody
