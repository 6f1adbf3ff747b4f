#pragma once
/// \file
/// Contacts between many markers and a few partners.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <tuple>
#include <vector>

#include <polybody/forces/contact_reach.hpp>
#include <polybody/forces/force_group.hpp>

namespace polybody {

/// Contacts between many markers and a few partners: links of a track and the rollers and ground under it, or balls
/// and walls.
///   auto const track = model.apply(ContactGroup<OnRoller, OnGround>{}, links, "left track");   many markers
///   model.add_partner(track, on_roller, wheel.at({0, 0, 0}), "wheel 1");                            one at a time
/// A law is a force element of two markers: the first is one of the many, the second is a partner. A law is evaluated
/// only if its `may_touch(first, second)` returns true for the frames of both markers. This test should cost little
/// more than the computation of a distance. If all laws have `reach(second)` (`HasReach`) and the group has at most 64
/// partners, several markers are tested at once with SIMD operations.
/// Theory: Eqs. 8.3, 8.12 to 8.14.
template <ForceElement... Laws>
  requires((Laws::markers == 2) && ...)
class ContactGroup {
 public:
  static_assert(((states_of<Laws>() == 0) && ...),
                "The contacts of a ContactGroup have no first-order states. Apply each contact with BristleFriction on "
                "its own, model.apply(contact, marker_a, marker_b).");
  static constexpr int markers = any_number;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = std::max({Laws::needs...});
  static constexpr bool all_laws_store = (HasPotential<Laws> && ...);  ///< true if each law has a potential

  /// Contact partner of the many markers.
  template <class Law>
  struct ContactPartner {
    Law law;           ///< contact law
    Index marker;      ///< index of the partner's marker in the group
    std::string name;  ///< name of the partner in messages and results
  };

  /// Sets the number of the many markers. They are the first `count` markers of the group. Called by the model.
  void set_many(Index count) { many_ = count; }
  Index many() const { return many_; }  ///< number of the many markers
  /// Keeps all partners and `count` of the many markers. The partners' markers follow them. Called for an island.
  void keep_many(Index count) {
    std::apply([&](auto&... few) { (shift(few, count - many_), ...); }, few_);
    many_ = count;
  }
  /// Number of partners.
  Index partners() const {
    return Index(std::apply([](auto const&... few) { return (few.size() + ... + std::size_t(0)); }, few_));
  }

  /// Adds a partner whose marker has the index `marker` in the group. Each of the many markers can touch the partner
  /// under `law`. Messages use `name`.
  template <class Law>
    requires(std::is_same_v<Law, Laws> || ...)
  void add_partner(Law const& law, Index marker, std::string name) {
    std::get<std::vector<ContactPartner<Law>>>(few_).push_back({law, marker, std::move(name)});
  }

  void check(std::string const& name) const;

  /// Calls f(partner) for each `ContactPartner`, ordered by the type of its law, then by the order of addition.
  template <class F>
  void for_each_partner(F&& f) const {
    std::apply([&](auto const&... few) { (each_of(few, f), ...); }, few_);
  }

  /// Calls visit(i, marker, law) for each marker i of the many and each partner, at any distance. `marker` is the index
  /// of the partner's marker.
  template <class Visit>
  void for_each_candidate(Visit&& visit) const {
    for (Index i = 0; i < many_; ++i) for_each_partner([&](auto const& few) { visit(i, few.marker, few.law); });
  }
  /// Calls visit(i, j, law) for the pairs with `may_touch` true: marker i of the many and the partner's marker j.
  /// frame(k) is the frame of marker k.
  template <class FrameOf, class Visit>
  void for_each_pair(FrameOf&& frame, Visit&& visit) const {
    for_each_pair(frame, visit, 0, many_);
  }
  /// Calls visit(i, j, law) for the pairs with `may_touch` true and i in [begin, end) only. frame(k) is the frame of
  /// marker k.
  template <class FrameOf, class Visit>
  void for_each_pair(FrameOf&& frame, Visit&& visit, Index begin, Index end) const {
    if constexpr ((HasReach<Laws> && ...))
      if (partners() <= 64) return for_each_near_pair(frame, visit, begin, end);
    for (Index i = begin; i < end; ++i)
      for_each_partner([&](auto const& few) {
        if (few.law.may_touch(frame(i), frame(few.marker))) visit(i, few.marker, few.law);
      });
  }

 private:
  static constexpr Index side_by_side = 32;
  /// Positions of some of the many markers, with one bit per partner for each marker. A bit is set if the marker is
  /// within the partner's reach. The bits have the order of `for_each_partner`.
  struct Row {
    std::array<double, side_by_side> x, y, z;
    std::array<std::uint64_t, side_by_side> near;
  };

  template <class FrameOf, class Visit>
  void for_each_near_pair(FrameOf& frame, Visit& visit, Index begin, Index end) const {
    Row row;
    for (Index first = begin; first < end; first += side_by_side) {
      Index const count = std::min(side_by_side, end - first);
      find_near(frame, first, count, row);
      for (Index k = 0; k < count; ++k) {
        std::uint64_t bits = row.near[std::size_t(k)];
        if (bits == 0) continue;
        std::apply([&](auto const&... few) { (visit_near(few, frame, visit, first + k, bits), ...); }, few_);
      }
    }
  }
  template <class FrameOf>
  void find_near(FrameOf& frame, Index first, Index count, Row& row) const {
    for (std::size_t k = 0; k < row.x.size(); ++k) {
      Vec3 const& r = frame(first + std::min(Index(k), count - 1)).r;
      row.x[k] = r[0];
      row.y[k] = r[1];
      row.z[k] = r[2];
    }
    row.near.fill(0);
    std::uint64_t bit = 1;
    for_each_partner([&](auto const& few) {
      ContactReach const reach = few.law.reach(frame(few.marker));
      for (std::size_t k = 0; k < row.x.size(); ++k) row.near[k] |= reach.holds(row.x[k], row.y[k], row.z[k]) ? bit : 0;
      bit <<= 1;
    });
  }
  /// Visits the partners in `few`, which have the same law type, if they may touch marker i. Removes the bits of these
  /// partners from `bits`.
  template <class Few, class FrameOf, class Visit>
  static void visit_near(Few const& few, FrameOf& frame, Visit& visit, Index i, std::uint64_t& bits) {
    std::size_t const n = few.size();
    std::uint64_t own = n < 64 ? bits & ((std::uint64_t(1) << n) - 1) : bits;
    for (; own != 0; own &= own - 1) {
      auto const& one = few[std::size_t(std::countr_zero(own))];
      if (one.law.may_touch(frame(i), frame(one.marker))) visit(i, one.marker, one.law);
    }
    bits = n < 64 ? bits >> n : 0;
  }
  template <class Few>
  static void shift(Few& few, Index by) {
    for (auto& one : few) one.marker += by;
  }
  template <class Few, class F>
  static void each_of(Few const& few, F& f) {
    for (auto const& one : few) f(one);
  }

  std::tuple<std::vector<ContactPartner<Laws>>...> few_;
  Index many_ = 0;
};

template <ForceElement... Laws>
  requires((Laws::markers == 2) && ...)
void ContactGroup<Laws...>::check(std::string const& name) const {
  for_each_partner([&](auto const& few) { few.law.check(name); });
}

}  // namespace polybody
