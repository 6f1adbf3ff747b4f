#pragma once
#include <algorithm>
#include <tuple>
#include <vector>

#include <polybody/forces/force_group.hpp>

namespace polybody {

/// Contacts between many bodies and a few: links of a track and what it runs over, balls and walls.
///   auto const track = model.apply(ContactGroup<OnRoller, OnGround>{}, links, "left track");   many markers
///   model.pair_with(track, on_roller, wheel.at({0, 0, 0}), "wheel 1");                            one at a time
/// A law is a force element of two markers: the first is one of the many, the second one of the few. It is evaluated
/// only where its `may_touch(first, second)` is true, which should cost little more than a distance.
template <ForceElement... Laws>
  requires((Laws::markers == 2) && ...)
class ContactGroup {
 public:
  static constexpr int markers = any_number;
  static constexpr bool is_load = false;
  static constexpr Observes needs = std::max({Laws::needs...});

  /// One of the few.
  template <class Law>
  struct Opponent {
    Law law;           ///< how the two touch
    Index marker;      ///< among the group's
    std::string name;  ///< name of the opponent in messages and results
  };

  /// The first `count` markers are the many; the model sets this.
  void set_many(Index count) { many_ = count; }
  Index many() const { return many_; }  ///< how many markers are the many: the first ones of the group

  /// Adds an opponent: under `law` each of the many may touch the group's marker number `marker`.
  template <class Law>
    requires(std::is_same_v<Law, Laws> || ...)
  void pair_with(Law const& law, Index marker, std::string name) {
    std::get<std::vector<Opponent<Law>>>(few_).push_back({law, marker, std::move(name)});
  }

  void check(std::string const& name) const;

  /// Calls f(opponent) for each `Opponent`: by the type of its law, then in the order in which they were added.
  template <class F>
  void for_each_opponent(F&& f) const {
    std::apply([&](auto const&... few) { (each_of(few, f), ...); }, few_);
  }

  /// Calls visit(i, marker, law) for each pair of one of the many, i, and an opponent, near or far.
  template <class Visit>
  void for_each_candidate(Visit&& visit) const {
    for (Index i = 0; i < many_; ++i) for_each_opponent([&](auto const& few) { visit(i, few.marker, few.law); });
  }
  /// Calls visit(i, marker, law) for the pairs whose law says that they may touch; frame(k) is the frame of marker k.
  template <class FrameOf, class Visit>
  void for_each_pair(FrameOf&& frame, Visit&& visit) const {
    for_each_pair(frame, visit, 0, many_);
  }
  /// The same for the markers [begin, end) of the many; frame(i) is that of marker i, visit(i, j, law) takes a pair.
  template <class FrameOf, class Visit>
  void for_each_pair(FrameOf&& frame, Visit&& visit, Index begin, Index end) const {
    for (Index i = begin; i < end; ++i)
      for_each_opponent([&](auto const& few) {
        if (few.law.may_touch(frame(i), frame(few.marker))) visit(i, few.marker, few.law);
      });
  }

 private:
  template <class Few, class F>
  static void each_of(Few const& few, F& f) {
    for (auto const& one : few) f(one);
  }

  std::tuple<std::vector<Opponent<Laws>>...> few_;
  Index many_ = 0;
};

template <ForceElement... Laws>
  requires((Laws::markers == 2) && ...)
void ContactGroup<Laws...>::check(std::string const& name) const {
  for_each_opponent([&](auto const& few) { few.law.check(name); });
}

}  // namespace polybody
