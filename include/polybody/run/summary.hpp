#pragma once
/// \file
/// Model summary: text with the bodies, joints, loops and forces of a model.

#include <polybody/run/problem_size.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

namespace detail {

/// Tree of the bodies of a model along joints, from the ground outwards. Bodies are indices in the layout; −1 is the
/// ground.
class JointGraph {
 public:
  template <class = void>
  explicit JointGraph(ModelLayout const& layout)
      : layout_(layout), found_(layout.bodies.size(), 0), joints_of_(layout.bodies.size() + 1) {
    for (Index j = 0; j < Index(layout.joints.size()); ++j) {
      auto const [a, b] = ends(j);
      joints_of_[std::size_t(a + 1)].push_back(j);
      if (a != b) joints_of_[std::size_t(b + 1)].push_back(j);
    }
    order_.reserve(layout.bodies.size());
    spread(-1);
    joined_ = order_.size();
    for (Index b = 0; b < Index(found_.size()); ++b)
      if (!found_[std::size_t(b)]) {
        take({b, -1, -1, 0});
        spread(b);
      }
  }

  /// Body, the joint that carries this body (−1 if none), and the body `by` at the other end of this joint.
  struct Carried {
    Index body, joint, by;
    int branch;  ///< number of branching bodies between the ground and this body
  };
  Sequence<Carried> const& order() const { return order_; }
  /// Number of bodies with a path of joints to the ground; these are the first in `order`.
  std::size_t joined() const { return joined_; }
  /// Joints that close loops: both of their bodies are carried by other joints.
  Sequence<Index> closing() const {
    Sequence<char> carries(layout_.joints.size(), 0);
    for (Carried const& c : order_)
      if (c.joint >= 0) carries[std::size_t(c.joint)] = 1;
    Sequence<Index> out;
    for (std::size_t j = 0; j < carries.size(); ++j)
      if (!carries[j] && ends(Index(j))[0] != ends(Index(j))[1]) out.push_back(Index(j));
    return out;
  }
  std::array<Index, 2> ends(Index joint) const {
    JointLayout const& j = layout_.joints[std::size_t(joint)];
    auto const owner = [&](Index marker) { return marker < 0 ? Index(-1) : layout_.owners[std::size_t(marker)]; };
    return {owner(j.a), owner(j.b)};
  }

 private:
  void take(Carried const& c) {
    found_[std::size_t(c.body)] = 1;
    order_.push_back(c);
  }
  /// Adds all bodies with a path of joints to body `from`, branch by branch.
  void spread(Index from) {
    Sequence<Carried> waiting;
    auto const offer = [&](Index by, int branch) {
      Sequence<Carried> next;
      for (Index const j : joints_of_[std::size_t(by + 1)]) {
        auto const [a, b] = ends(j);
        Index const other = a == by ? b : a;
        if (other != by && other >= 0 && !found_[std::size_t(other)]) next.push_back({other, j, by, branch});
      }
      int const inner = next.size() > 1 ? branch + 1 : branch;
      for (std::size_t k = next.size(); k-- > 0;) {
        next[k].branch = inner;
        waiting.push_back(next[k]);
      }
    };
    offer(from, 0);
    while (!waiting.empty()) {
      Carried const c = waiting.back();
      waiting.pop_back();
      if (found_[std::size_t(c.body)]) continue;
      take(c);
      offer(c.body, c.branch);
    }
  }

  ModelLayout const& layout_;
  Sequence<char> found_;
  Sequence<Sequence<Index>> joints_of_;  ///< joints of each body, by index of the body plus one; the ground is first
  Sequence<Carried> order_;
  std::size_t joined_ = 0;
};

template <class = void>
std::string body_or_ground(ModelLayout const& layout, Index body) {
  return body < 0 ? "the ground" : layout.bodies[std::size_t(body)].name;
}
template <class = void>
std::string counted(Index n, char const* one, char const* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}
template <class = void>
std::string joint_in_words(JointLayout const& j) {
  return sentence_of({"\"", j.name, "\" (",
                      (j.rows > 0 ? counted(j.rows, "equation", "equations") : std::string("compliant")),
                      (j.eliminated ? ", eliminated)" : ")")});
}
template <class = void>
std::string force_in_words(ModelLayout const& layout, ForceLayout const& f) {
  std::string text = sentence_of({"force \"", f.name, "\""});
  constexpr std::size_t most = 6;  // a contact group has hundreds
  Sequence<Index> bodies;
  for (Index const marker : f.markers) {
    Index const body = layout.owners[std::size_t(marker)];
    if (std::find(bodies.begin(), bodies.end(), body) == bodies.end()) bodies.push_back(body);
  }
  for (std::size_t k = 0; k < std::min(bodies.size(), most); ++k)
    text += (k == 0 ? " on " : ", ") + body_or_ground(layout, bodies[k]);
  if (bodies.size() > most) text += sentence_of({" and ", std::to_string(bodies.size() - most), " more"});
  if (f.states > 0) text += ", " + counted(f.states, "state", "states");
  return text;
}

}  // namespace detail

/// Model summary: counts; a line for each body from the ground outwards, with the joint that carries it, indented at
/// branches; joints that close loops; bodies without a path of joints to the ground; forces and the bodies on which
/// they act. Ends with a line break.
template <class = void>
std::string summary(ModelLayout const& layout) {
  detail::JointGraph const graph(layout);
  auto const counted = [](Index n, char const* one, char const* many) { return detail::counted(n, one, many); };
  std::string text = sentence_of({counted(Index(layout.bodies.size()), "body", "bodies"), " (",
                                  counted(layout.coordinates, "coordinate", "coordinates"), ", ",
                                  counted(layout.velocities, "velocity", "velocities"), "), ",
                                  counted(Index(layout.joints.size()), "joint", "joints"), " (",
                                  counted(layout.rows, "equation", "equations"), "), ",
                                  counted(Index(layout.forces.size()), "force", "forces"), "; gravity (",
                                  layout.gravity[0], ", ", layout.gravity[1], ", ", layout.gravity[2], ") m/s²\n"});
  for (std::size_t k = 0; k < graph.order().size(); ++k) {
    auto const& c = graph.order()[k];
    BodyLayout const& b = layout.bodies[std::size_t(c.body)];
    text += std::string(std::size_t(2 * (c.branch + 1)), ' ');
    text += sentence_of({b.name, ": ", counted(b.coordinates, "coordinate", "coordinates")});
    if (c.joint >= 0)
      text += sentence_of({", by ", detail::joint_in_words(layout.joints[std::size_t(c.joint)]), " on ",
                           detail::body_or_ground(layout, c.by)});
    else
      text += ", not joined to the ground";
    text += "\n";
  }
  for (Index const j : graph.closing()) {
    auto const [a, b] = graph.ends(j);
    text += sentence_of({"closes a loop: ", detail::joint_in_words(layout.joints[std::size_t(j)]), ", ",
                         detail::body_or_ground(layout, a), " and ", detail::body_or_ground(layout, b), "\n"});
  }
  for (ForceLayout const& f : layout.forces) text += detail::force_in_words(layout, f) + "\n";
  return text;
}
/// Summary of a model: bodies, joints, loops and forces.
template <class M>
std::string summary(M const& model) {
  return summary(layout_of(model));
}

}  // namespace polybody
