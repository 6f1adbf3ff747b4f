#pragma once
/// \file
/// Contacts among the members of a set of shapes: search of near pairs, forces and tangents.
/// Theory: Eqs. 8.3, 8.12, 8.13, 9.69.

#include <algorithm>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>

#include <polybody/forces/shapes/member_shapes.hpp>
#include <polybody/math/type_list.hpp>

namespace polybody {

/// Shape of a member of a contact set. A shape with `extent(frame)` is bounded (`BoundedShape`); a shape without this
/// function, such as a plane, has no contact with other unbounded shapes.
template <class S>
concept ContactShape = requires(S const shape, std::string const name) {
  { S::needs } -> std::convertible_to<MarkerKind>;
  shape.check(name);
};
/// Contact shape inside of an axis-aligned box.
template <class S>
concept BoundedShape = ContactShape<S> && requires(S const shape, Frame<double> const at) {
  { shape.extent(at) } -> std::same_as<Extent>;
};
/// Shapes S and T with a contact geometry `pair_geometry(a, b)`, a of type S and b of type T.
template <class S, class T>
concept ShapePair = requires(S const a, T const b) {
  { pair_geometry(a, b) } -> ContactGeometry;
};

/// List of the types of shapes that a contact set can contain.
template <ContactShape... Ss>
struct Shapes {};

/// Contacts among all members of a set: balls, rods and boxes, and the planes under them.
///   using Pile = ContactSet<Shapes<Sphere, Box, Plane>>;
///   auto const pile = model.apply(Pile{{.stiffness = 1e5, .damping = 50.0}}, "pile");
///   model.add_member(pile, Sphere{.radius = 0.1}, ball.centre());                           one at a time
///   model.add_member(pile, Plane{}, model.ground().at({0, 0, 0}), "floor");
/// A member is a shape at a marker. All pairs have the same law of the normal force and the same friction. Members on
/// one body have no contact with each other, nor have members with the same positive number of their group, nor
/// excluded pairs. A grid finds the pairs that are near each other (`PairSearch`). The sums of the forces have an order
/// that depends only on the positions, so that runs are bitwise repeatable.
template <class ShapeList, NormalForce N = SpringDamperContact, ContactFriction F = Friction>
class ContactSet;
/// Contact set with shapes of the types `Ss`.
template <ContactShape... Ss, NormalForce N, ContactFriction F>
class ContactSet<Shapes<Ss...>, N, F> {
 public:
  static_assert(!std::same_as<F, BristleFriction>,
                "The contacts of a ContactSet have no first-order states. Apply each contact with BristleFriction on "
                "its own, model.apply(contact, marker_a, marker_b).");
  static constexpr int markers = any_number;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = std::max({MarkerKind::point, Ss::needs...});
  static constexpr bool all_laws_store = true;  ///< each normal force has a potential
  using Search = PairSearch;                    ///< pairs that are kept between evaluations

  /// Member of type S.
  template <class S>
  struct Member {
    S shape;       ///< shape at the marker
    Index marker;  ///< index of its marker, and of the member, in the set
  };

  /// Set without members, with the law `normal` of the normal force and the friction `friction` of all pairs.
  explicit ContactSet(N const& normal, F const& friction = {}) : normal_(normal), friction_(friction) {}

  Index members() const { return Index(places_.size()); }  ///< number of members
  /// Name of member m in messages and results.
  std::string const& name_of(Index m) const { return places_[std::size_t(m)].name; }
  /// True if neither friction nor the normal force dissipates energy.
  bool is_lossless() const
    requires requires(N const& law) { law.is_lossless(); }
  {
    return friction_.coefficient == 0.0 && normal_.is_lossless();
  }
  void check(std::string const& name) const {
    normal_.check(name);
    friction_.check(name);
  }

  /// Adds a member. Called by the model. \param body number of the body of the marker \param group group of the member;
  /// members of the same positive group have no contact with each other
  template <OneOf<Ss...> S>
  void add_member(S const& shape, Index body, int group, std::string name) {
    auto& same = std::get<Sequence<Member<S>>>(members_);
    places_.push_back({type_of<S>(), Index(same.size()), body, group, std::move(name)});
    same.push_back({shape, members() - 1});
  }
  /// Excludes the contact of the members m and n. Called by the model.
  void exclude(Index m, Index n) {
    std::pair const pair = in_order(m, n);
    auto const at = std::lower_bound(excluded_.begin(), excluded_.end(), pair);
    Index const place = Index(at - excluded_.begin());
    excluded_.push_back(pair);
    std::rotate(excluded_.begin() + place, excluded_.end() - 1, excluded_.end());
  }

  /// Calls visit(i, j, law) for each pair of members that can have a contact, at any distance.
  template <class Visit>
  void for_each_candidate(Visit&& visit) const {
    each_pair_type([&]<std::size_t s, std::size_t t>() {
      for (Index i = 0; i < Index(of<s>().size()); ++i)
        for (Index j = s == t ? i + 1 : 0; j < Index(of<t>().size()); ++j)
          if (may_pair(marker<s>(i), marker<t>(j)))
            with_pair<s, t>(i, j, [&](Index a, Index b, auto const& geometry) { visit(a, b, law_of(geometry)); });
    });
  }
  /// Calls visit(i, j, law) for the pairs with `may_touch` true. frame(k) is the frame of marker k.
  template <class FrameOf, class Visit>
  void for_each_pair(FrameOf&& frame, Visit&& visit) const {
    PairSearch search;
    for_each_pair(search, frame, visit);
  }
  /// Overload that keeps the near pairs in `search` between evaluations, and calls visit(i, j, law). frame(k) is
  /// the frame of marker k.
  template <class FrameOf, class Visit>
  void for_each_pair(PairSearch& search, FrameOf&& frame, Visit&& visit) const {
    update(search, frame);
    std::uint64_t const* key = search.pairs().begin();
    std::uint64_t const* const end = search.pairs().end();
    each_pair_type([&]<std::size_t s, std::size_t t>() {
      for (; key != end && (*key >> 56) == pair_type(s, t); ++key)
        with_pair<s, t>(Index((*key >> 28) & index_bits), Index(*key & index_bits),
                        [&](Index a, Index b, auto const& geometry) {
                          if (geometry.may_touch(frame(a), frame(b))) visit(a, b, law_of(geometry));
                        });
    });
  }

 private:
  static constexpr std::size_t types = sizeof...(Ss);
  static constexpr std::uint64_t index_bits = (std::uint64_t(1) << 28) - 1;
  template <std::size_t s>
  using Type = std::tuple_element_t<s, std::tuple<Ss...>>;
  /// Data of a member that do not depend on its type.
  struct Place {
    std::size_t type;  ///< number of its type
    Index index;       ///< index among the members of its type
    Index body;        ///< number of its body
    int group;
    std::string name;
  };

  static std::pair<Index, Index> in_order(Index m, Index n) { return {std::min(m, n), std::max(m, n)}; }
  template <class S>
  static constexpr std::size_t type_of() {
    bool const equal[] = {std::is_same_v<S, Ss>...};
    return std::size_t(std::find(equal, equal + types, true) - equal);
  }
  static constexpr std::uint64_t pair_type(std::size_t s, std::size_t t) { return s * types + t; }
  template <std::size_t s>
  auto const& of() const {
    return std::get<s>(members_);
  }
  template <std::size_t s>
  Index marker(Index i) const {
    return of<s>()[std::size_t(i)].marker;
  }
  template <class G>
  Contact<G, N, F> law_of(G const& geometry) const {
    return {geometry, normal_, friction_};
  }

  /// Calls use<s, t>() for each pair of types with s ≤ t, except pairs of unbounded shapes.
  template <class Use>
  static void each_pair_type(Use&& use) {
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      (..., [&] {
        constexpr std::size_t s = k / types, t = k % types;
        if constexpr (s <= t && (BoundedShape<Type<s>> || BoundedShape<Type<t>>)) use.template operator()<s, t>();
      }());
    }(std::make_index_sequence<types * types>{});
  }
  /// Calls use(a, b, geometry) for member i of type s and member j of type t, in the order of the geometry.
  template <std::size_t s, std::size_t t, class Use>
  void with_pair(Index i, Index j, Use&& use) const {
    static_assert(ShapePair<Type<s>, Type<t>> || ShapePair<Type<t>, Type<s>>,
                  "Two shapes of a ContactSet need a contact geometry, pair_geometry(a, b).");
    auto const& a = of<s>()[std::size_t(i)];
    auto const& b = of<t>()[std::size_t(j)];
    if constexpr (ShapePair<Type<s>, Type<t>>)
      use(a.marker, b.marker, pair_geometry(a.shape, b.shape));
    else
      use(b.marker, a.marker, pair_geometry(b.shape, a.shape));
  }
  /// True unless the members m and n are on one body, in one group or excluded.
  bool may_pair(Index m, Index n) const {
    Place const &a = places_[std::size_t(m)], &b = places_[std::size_t(n)];
    if (a.body == b.body || (a.group > 0 && a.group == b.group)) return false;
    return excluded_.empty() || !std::binary_search(excluded_.begin(), excluded_.end(), in_order(m, n));
  }

  template <class FrameOf>
  void update(PairSearch& search, FrameOf& frame) const {
    search.begin(places_.size());
    bool valid = search.searched();
    each_type([&](auto const& same) {
      if constexpr (requires { same[0].shape.extent(frame(0)); })
        for (auto const& one : same)
          valid = search.encloses(std::size_t(one.marker), one.shape.extent(frame(one.marker))) && valid;
    });
    if (!valid) find(search);
  }
  /// Lists the near pairs. Members and unbounded members are pairs at any distance.
  void find(PairSearch& search) const {
    auto& pairs = search.pairs();
    pairs.clear();
    search.find([&](std::size_t m, std::size_t n) { add_pair(Index(m), Index(n), pairs); });
    each_pair_type([&]<std::size_t s, std::size_t t>() {
      if constexpr (!BoundedShape<Type<s>> || !BoundedShape<Type<t>>)
        for (auto const& a : of<s>())
          for (auto const& b : of<t>()) add_pair(a.marker, b.marker, pairs);
    });
    std::sort(pairs.begin(), pairs.end());
  }
  void add_pair(Index m, Index n, Sequence<std::uint64_t>& pairs) const {
    if (!may_pair(m, n)) return;
    Place const *a = &places_[std::size_t(m)], *b = &places_[std::size_t(n)];
    if (std::pair(b->type, b->index) < std::pair(a->type, a->index)) std::swap(a, b);
    pairs.push_back(pair_type(a->type, b->type) << 56 | std::uint64_t(a->index) << 28 | std::uint64_t(b->index));
  }
  template <class Use>
  void each_type(Use&& use) const {
    std::apply([&](auto const&... same) { (use(same), ...); }, members_);
  }

  N normal_;
  F friction_;
  std::tuple<Sequence<Member<Ss>>...> members_;
  Sequence<Place> places_;
  Sequence<std::pair<Index, Index>> excluded_;  // sorted
};

}  // namespace polybody
