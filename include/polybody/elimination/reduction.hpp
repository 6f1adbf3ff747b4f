#pragma once
/// \file
/// Reduction of a model's unknowns to those of a time step. Reduced vectors contain the unknowns that no policy
/// eliminates, full vectors contain all unknowns. Reduced q and v contain the independent coordinates of bodies without
/// a carrying joint, and the joint coordinates and deformations of carried bodies. Reduced v also contains the
/// first-order states. The reduced multipliers are those of the remaining constraint equations of joints and bodies.

#include <algorithm>

#include <polybody/elimination/joint_tree.hpp>
#include <polybody/elimination/linear_elimination.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/model.hpp>
#include <polybody/system/model_operations.hpp>

namespace polybody {

/// Elimination of coordinates from a time step: by joints with joint coordinates, which form a tree, and by linear
/// joints. \tparam T scalar type of the vectors
template <class T = double>
class ReductionOf {
 public:
  /// \throws InvalidInput if joints with joint coordinates close a loop. \throws InconsistentInitialConditions if
  /// linear joints contradict each other.
  template <class M>
  explicit ReductionOf(M const& model) : linear_(model.linear_rows()) {
    if constexpr (!std::is_void_v<typename M::Solution>) grow_tree(model);
    Sequence<Extent> extents;
    model.for_each_body([&](auto const& e) {
      using B = std::decay_t<decltype(e.body)>;
      extents.push_back({e.q0, e.body.coordinates(), e.v0, e.body.velocities()});
      if constexpr (HasFrameNodes<B>) extents.back().nodes = e.body.elements() + 1;
    });
    number_unknowns(extents, model.coordinates(), model.velocities(), model.states());
    Sequence<bool> eliminated(std::size_t(model.rows()), false);
    model.for_each_joint([&](auto const& e) {
      using J = std::decay_t<decltype(e.joint)>;
      if constexpr (EliminatingPolicy<typename J::PolicyType>) std::fill_n(eliminated.begin() + e.row, e.rows, true);
    });
    number_rows(eliminated, model.nonholonomic_equations());
  }

  Index coordinates() const { return coordinates_; }                ///< number of reduced coordinates
  Index velocities() const { return velocities_; }                  ///< number of reduced velocities
  Index rows() const { return Index(rows_.size()); }                ///< number of remaining constraint equations
  JointTreeOf<T> const& tree() const { return tree_; }              ///< tree of bodies with joint coordinates
  LinearEliminationOf<T> const& linear() const { return linear_; }  ///< elimination by linear joints
  /// Positions of the bodies in the reduced vectors, in the order of `for_each_body`.
  Sequence<ReducedPosition> const& places() const { return places_; }
  /// Indices of the remaining constraint equations in the model.
  Sequence<Index> const& remaining_equations() const { return rows_; }
  /// Indices of the nonholonomic equations among the remaining equations.
  Sequence<Index> const& nonholonomic_equations() const { return nonholonomic_equations_; }
  /// Full velocity index of reduced velocity i. For a joint coordinate this is the first velocity of the carried body.
  Index full_velocity(Index i) const { return full_velocity_[std::size_t(i)]; }
  /// Index in the tree of the body that is carried by the joint whose first constraint equation is `row`; −1: none.
  Index carried_by(Index row) const { return carried_by_[std::size_t(row)]; }

  /// Copies from `reduced` to `full` the coordinates that both vectors contain.
  void expand_coordinates(VecXOf<T> const& reduced, VecXOf<T>& full) const {
    for (auto const& [n, w] : same_q_) full[w] = reduced[n];
  }
  /// Copies from `full` to `reduced` the coordinates that both vectors contain.
  void reduce_coordinates(VecX const& full, VecX& reduced) const {
    for (auto const& [n, w] : same_q_) reduced[n] = full[w];
  }
  /// Copies from `reduced` to `full` the generalised velocities that both vectors contain.
  void expand_velocities(VecXOf<T> const& reduced, VecXOf<T>& full) const {
    for (auto const& [n, w] : same_v_) full[w] = reduced[n];
  }
  /// Copies from `full` to `reduced` the generalised velocities that both vectors contain.
  void reduce_velocities(VecXOf<T> const& full, VecXOf<T>& reduced) const {
    for (auto const& [n, w] : same_v_) reduced[n] = full[w];
  }
  /// Copies the multipliers of the remaining equations from `reduced` to `full`. Other multipliers are set to zero.
  void expand_rows(VecX const& reduced, VecX& full) const {
    full.setZero();
    for (std::size_t i = 0; i < rows_.size(); ++i) full[rows_[i]] = reduced[Index(i)];
  }
  /// Copies the multipliers of the remaining equations from `full` to `reduced`.
  void reduce_rows(VecX const& full, VecX& reduced) const {
    for (std::size_t i = 0; i < rows_.size(); ++i) reduced[Index(i)] = full[rows_[i]];
  }

 private:
  /// Attachment of a joint to a body, before the construction of the tree.
  struct BodyAttachment {
    Index body = -1;  ///< index of the body; −1: the ground
    Placement frame;
    FloatingEndOf<T> end = {};  ///< replaces the frame on a flexible body
  };
  struct Link {
    std::string name;
    Index row;
    BodyAttachment a, b;
    JointMotions motions;
  };

  /// First coordinate and velocity of a body in the model, and numbers of coordinates, velocities and nodes.
  struct Extent {
    Index q0, nq, v0, nv, nodes = 0;
  };

  template <class M>
  void grow_tree(M const& model) {
    Sequence<TreeBody> bodies;
    Sequence<BodyAttachment> attachments(std::size_t(model.markers()));
    std::apply([&](auto const&... pool) { (add_attachments(pool, bodies, attachments), ...); }, model.body_pools());
    for (detail::GroundMarker const& g : model.ground_markers())
      attachments[std::size_t(g.published)].frame = g.placement;
    Sequence<Link> links;
    model.for_each_joint([&](auto const& e) {
      using J = std::decay_t<decltype(e.joint)>;
      if constexpr (JointCoordinatePolicy<typename J::PolicyType>) {
        BodyAttachment const &a = attachments[std::size_t(e.a)], &b = attachments[std::size_t(e.b)];
        bool const plane = bodies[std::size_t(a.body < 0 ? b.body : a.body)].layout == RigidLayout::plane;
        JointMotions const motions = motions_of(e.joint.geometry);
        links.push_back({e.name, e.row, a, b, plane ? in_plane(motions, a.frame.axes) : motions});
      }
    });
    build_tree(bodies, links, model.reference_state().q,
               std::is_same_v<typename M::Solution, joint_coordinates::ArticulatedBody>);
    carried_by_.assign(std::size_t(model.rows()), -1);
    for (std::size_t i = 0; i < tree_.bodies.size(); ++i)
      if (tree_.bodies[i].carried()) carried_by_[std::size_t(tree_.bodies[i].row)] = Index(i);
  }

  template <class B>
  static void add_attachments(detail::BodyPool<B> const& pool, Sequence<TreeBody>& bodies,
                              Sequence<BodyAttachment>& attachments) {
    if constexpr (HasRigidLayout<B>) {
      Index const first = Index(bodies.size());
      for (auto const& e : pool.entries) {
        bodies.push_back({.name = e.name, .layout = B::layout, .q0 = e.q0, .v0 = e.v0});
        bodies.back().by_newton_euler = moves_by_newton_euler<B>;
        detail::read_masses(e.body, bodies.back());
      }
      for (auto const& m : pool.markers) {
        BodyAttachment& h = attachments[std::size_t(m.published)];
        h.body = first + m.body;
        for (Index k = 0; k < m.point.u.size(); ++k) h.frame.origin[k] = m.point.u[k];
        h.frame.axes = m.axes;
      }
    } else if constexpr (FloatingFrameBody<B>) {
      Index const first = Index(bodies.size());
      for (auto const& e : pool.entries)
        bodies.push_back(
            {.name = e.name, .layout = B::frame_layout, .q0 = e.q0, .v0 = e.v0, .deformations = e.body.deformations()});
      for (auto const& m : pool.markers) {
        BodyAttachment& h = attachments[std::size_t(m.published)];
        auto const& e = pool.entries[std::size_t(m.body)];
        h.body = first + m.body;
        h.frame.axes = m.axes;
        h.end = {&publish_end<B>, &e.body, &m.point, m.axes, B::frame_layout, e.q0, e.v0, e.body.deformations()};
      }
    } else if constexpr (HasFrameNodes<B>) {
      constexpr RigidLayout layout = B::world == World::plane ? RigidLayout::plane : RigidLayout::quaternion;
      constexpr Index nq = layout == RigidLayout::plane ? 3 : 7, nv = B::element_stride;
      Sequence<Index> first;
      for (auto const& e : pool.entries) {
        first.push_back(Index(bodies.size()));
        for (Index k = 0; k <= e.body.elements(); ++k)
          bodies.push_back(
              {.name = e.name, .layout = layout, .q0 = e.q0 + k * nq, .v0 = e.v0 + k * nv, .chain = first.back()});
      }
      for (auto const& m : pool.markers) {
        Index const node = B::node_of(m.point);
        if (node < 0) continue;
        BodyAttachment& h = attachments[std::size_t(m.published)];
        h.body = first[std::size_t(m.body)] + node;
        h.frame = {pool.entries[std::size_t(m.body)].body.node_arm(m.point), m.axes};
      }
    }
  }
  template <class B>
  static void publish_end(FloatingEndOf<T> const& end, T const* q, T const* v, MarkerKinematics<T>& out) {
    B const& body = *static_cast<B const*>(end.body);
    body.template evaluate_marker<T>(*static_cast<typename B::Point const*>(end.point), end.axes,
                                     std::span<T const>(q, std::size_t(body.coordinates())),
                                     std::span<T const>(v, std::size_t(body.velocities())), out);
  }
  /// Adds a floating end to the tree and returns its index; −1 for a frame on a rigid body or the ground.
  Index add_end(BodyAttachment const& attachment) {
    if (!attachment.end.evaluate_marker) return -1;
    FloatingEndOf<T> end = attachment.end;
    end.first_column = tree_.ends.empty() ? 0 : tree_.ends.back().first_column + tree_.ends.back().deformations;
    tree_.ends.push_back(end);
    return Index(tree_.ends.size()) - 1;
  }

  /// Requires links without loops. \throws InvalidInput if a joint closes a loop; the message names the first such
  /// joint in the order of connection.
  static void require_tree(std::size_t bodies, Sequence<Link> const& links);

  /// Builds the tree breadth first from the ground, then from one body of each group without connection to the ground.
  /// Every joint with joint coordinates carries one body. If `all` is true, bodies without such joints become roots.
  void build_tree(Sequence<TreeBody> const& bodies, Sequence<Link> const& links, VecX const& reference, bool all);

  /// Adds the roots without joints: all bodies if `all` is true, and the free nodes of each chain with a carried node,
  /// which have `free_motions`. \param place index of each body in the tree; −1: none
  void add_roots(Sequence<TreeBody> const& bodies, bool all, Sequence<Index>& place);

  void number_unknowns(Sequence<Extent> const& extents, Index coordinates, Index velocities, Index states) {
    Sequence<bool> dependent_v(std::size_t(velocities), false), dependent_q(std::size_t(coordinates), false);
    for (auto const& d : linear_.dependents()) dependent_v[std::size_t(d.v)] = dependent_q[std::size_t(d.q)] = true;
    Sequence<Index> in_tree(std::size_t(velocities) + 1, -1);  // index in the tree, by first velocity
    for (std::size_t i = 0; i < tree_.bodies.size(); ++i) in_tree[std::size_t(tree_.bodies[i].v0)] = Index(i);
    places_.resize(extents.size());
    Sequence<std::size_t> order(extents.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return extents[a].v0 < extents[b].v0; });
    for (std::size_t const i : order) {
      Extent const& x = extents[i];
      ReducedPosition& place = places_[i];
      place.q = coordinates_;
      place.v = velocities_;
      TreeBody* const body = x.nv == 0 || in_tree[std::size_t(x.v0)] < 0
                                 ? nullptr
                                 : &tree_.bodies[std::size_t(in_tree[std::size_t(x.v0)])];
      if (body && x.nodes == 0) {
        body->qn = coordinates_;
        body->vn = velocities_;
      }
      if (number_nodes(x, in_tree)) {
        place.kind = ReducedPosition::Kind::carried;
      } else if (body && x.nodes == 0 && body->carried()) {
        place.kind = ReducedPosition::Kind::carried;
        coordinates_ += body->motions.coordinates();
        velocities_ += body->motions.velocities();
        full_velocity_.resize(std::size_t(velocities_), x.v0);
        for (Index k = body->deformations; k > 0; --k) {
          same_q_.emplace_back(coordinates_++, x.q0 + x.nq - k);
          same_v_.emplace_back(velocities_++, x.v0 + x.nv - k);
          full_velocity_.push_back(x.v0 + x.nv - k);
        }
      } else {
        for (Index j = x.q0; j < x.q0 + x.nq; ++j)
          if (!dependent_q[std::size_t(j)]) same_q_.emplace_back(coordinates_++, j);
        for (Index j = x.v0; j < x.v0 + x.nv; ++j) {
          if (dependent_v[std::size_t(j)]) {
            place.kind = ReducedPosition::Kind::reduced;
            continue;
          }
          same_v_.emplace_back(velocities_++, j);
          full_velocity_.push_back(j);
        }
      }
      place.coordinates = coordinates_ - place.q;
      place.velocities = velocities_ - place.v;
    }
    for (Index j = velocities - states; j < velocities; ++j) {
      same_v_.emplace_back(velocities_++, j);
      full_velocity_.push_back(j);
    }
  }

  /// Numbers the unknowns of the nodes of a chain if the tree moves it; otherwise only those of nodes that carry
  /// bodies. Returns true in the first case. \param in_tree index in the tree of the node with each first velocity; −1:
  /// none
  bool number_nodes(Extent const& x, Sequence<Index> const& in_tree) {
    bool moved = false;
    for (Index k = 0; k < x.nodes; ++k)
      if (Index const at = in_tree[std::size_t(x.v0 + k * x.nv / x.nodes)]; at >= 0) {
        TreeBody& node = tree_.bodies[std::size_t(at)];
        node.qn = coordinates_ + k * x.nq / x.nodes;
        node.vn = velocities_ + k * x.nv / x.nodes;
        moved = moved || node.motions.count > 0 || node.carried();
      }
    for (Index k = 0; k < x.nodes && moved; ++k)
      number_node(tree_.bodies[std::size_t(in_tree[std::size_t(x.v0 + k * x.nv / x.nodes)])]);
    return moved;
  }
  /// Numbers the unknowns of a node: the joint coordinates of a carried node, or those of a free node in the full
  /// vectors.
  void number_node(TreeBody& node) {
    node.qn = coordinates_;
    node.vn = velocities_;
    Index const nq = node.motions.coordinates(), nv = node.motions.velocities();
    for (Index k = 0; k < nq && !node.carried(); ++k) same_q_.emplace_back(node.qn + k, node.q0 + k);
    for (Index k = 0; k < nv && !node.carried(); ++k) same_v_.emplace_back(node.vn + k, node.v0 + k);
    for (Index k = 0; k < nv; ++k) full_velocity_.push_back(node.v0 + (node.carried() ? 0 : k));
    coordinates_ += nq;
    velocities_ += nv;
  }

  /// \param eliminated true for each constraint equation that a policy eliminates
  void number_rows(Sequence<bool> const& eliminated, Sequence<Index> const& of_velocity) {
    for (Index i = 0; i < Index(eliminated.size()); ++i)
      if (!eliminated[std::size_t(i)]) rows_.push_back(i);
    for (Index const i : of_velocity)
      nonholonomic_equations_.push_back(Index(std::lower_bound(rows_.begin(), rows_.end(), i) - rows_.begin()));
  }

  LinearEliminationOf<T> linear_;
  JointTreeOf<T> tree_;
  Sequence<Index> order_;
  Index coordinates_ = 0, velocities_ = 0;
  Sequence<ReducedPosition> places_;
  Sequence<std::pair<Index, Index>> same_q_, same_v_;  // reduced index, full index
  Sequence<Index> full_velocity_, rows_, nonholonomic_equations_, carried_by_;
};

template <class T>
void ReductionOf<T>::require_tree(std::size_t bodies, Sequence<Link> const& links) {
  Sequence<std::size_t> towards(bodies + 1);  // the ground is last
  for (std::size_t i = 0; i <= bodies; ++i) towards[i] = i;
  auto const part_of = [&](Index body) {
    std::size_t i = body < 0 ? bodies : std::size_t(body);
    while (towards[i] != i) i = towards[i] = towards[towards[i]];
    return i;
  };
  Sequence<Link const*> order;
  for (Link const& link : links) order.push_back(&link);
  std::sort(order.begin(), order.end(), [](Link const* a, Link const* b) { return a->row < b->row; });
  for (Link const* const link : order) {
    std::size_t const a = part_of(link->a.body), b = part_of(link->b.body);
    if (a == b)
      throw InvalidInput("joint_coordinates.loop", {"\"", ErrorObject{link->name},
                                                    "\" closes a loop of joints with joint coordinates. Give one joint "
                                                    "of the loop another policy, such as Constraint."});
    towards[a] = b;
  }
}

template <class T>
void ReductionOf<T>::build_tree(Sequence<TreeBody> const& bodies, Sequence<Link> const& links, VecX const& reference,
                                bool all) {
  require_tree(bodies.size(), links);
  Sequence<Index> place(bodies.size(), -1);
  Sequence<bool> used(links.size(), false);
  Sequence<Sequence<std::size_t>> links_of(bodies.size() + 1);  // entry 0: links of the ground; entry i + 1: of body i
  for (std::size_t k = 0; k < links.size(); ++k) {
    links_of[std::size_t(links[k].a.body + 1)].push_back(k);
    links_of[std::size_t(links[k].b.body + 1)].push_back(k);
  }
  auto const carry_from = [&](Index body) {  // −1: the ground
    for (std::size_t const k : links_of[std::size_t(body + 1)]) {
      Link const& link = links[k];
      if (used[k]) continue;
      used[k] = true;
      bool const backwards = link.a.body != body;
      BodyAttachment const& from = backwards ? link.b : link.a;
      BodyAttachment const& to = backwards ? link.a : link.b;
      TreeBody next = bodies[std::size_t(to.body)];
      next.row = link.row;
      next.parent = body < 0 ? -1 : place[std::size_t(body)];
      next.from = from.frame;
      next.to = to.frame;
      next.from_turned = !from.frame.axes.isIdentity(0.0);
      next.to_turned = !to.frame.axes.isIdentity(0.0);
      next.from_end = add_end(from);
      next.to_end = add_end(to);
      next.motions = link.motions;
      next.backwards = backwards;
      if (next.layout == RigidLayout::plane)
        next.angle = reference[next.q0 + 2] - (body < 0 ? 0.0 : reference[bodies[std::size_t(body)].q0 + 2]);
      if (next.from_end < 0 && next.to_end < 0)
        prepare_turn(next, reference.data(), body < 0 ? -1 : bodies[std::size_t(body)].q0);
      place[std::size_t(to.body)] = Index(tree_.bodies.size());
      order_.push_back(to.body);
      tree_.bodies.push_back(std::move(next));
    }
  };
  auto const grow = [&](std::size_t from) {
    for (std::size_t i = from; i < order_.size(); ++i) carry_from(order_[i]);
  };
  carry_from(-1);
  grow(0);
  for (std::size_t k = 0; k < links.size(); ++k) {
    if (used[k]) continue;
    Index const root = std::min(links[k].a.body, links[k].b.body);
    place[std::size_t(root)] = Index(tree_.bodies.size());
    tree_.bodies.push_back(bodies[std::size_t(root)]);
    order_.push_back(root);
    grow(order_.size() - 1);
  }
  order_.clear();
  add_roots(bodies, all, place);
}

template <class T>
void ReductionOf<T>::add_roots(Sequence<TreeBody> const& bodies, bool all, Sequence<Index>& place) {
  Sequence<bool> moved(bodies.size(), false);  // by chain
  for (TreeBody const& node : tree_.bodies)
    if (node.chain >= 0 && node.carried()) moved[std::size_t(node.chain)] = true;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bool const is_node = bodies[i].chain >= 0 && moved[std::size_t(bodies[i].chain)];
    if (place[i] < 0 && (all || is_node)) {
      place[i] = Index(tree_.bodies.size());
      tree_.bodies.push_back(bodies[i]);
    }
    if (TreeBody* const node = is_node ? &tree_.bodies[std::size_t(place[i])] : nullptr; node && !node->carried())
      node->motions = free_motions(node->layout == RigidLayout::plane);
  }
}

using Reduction = ReductionOf<>;  ///< reduction of vectors of doubles

}  // namespace polybody
