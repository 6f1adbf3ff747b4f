#pragma once
/// \file
/// Links of a track, as a part of any model that has their types. For vehicles; not included by polybody.hpp.

#include <vector>

#include <polybody/system/subassembly.hpp>
#include <polybody/vehicle/track_links.hpp>
#include <polybody/vehicle/tracked_vehicle.hpp>
#include <polybody/vehicle/vehicle_options.hpp>

namespace polybody::m113 {

/// Links of one track.
template <class Link>
struct LinkParts {
  std::vector<BodyHandle<Link>> links = {};  ///< links in the order of the track; pin i is in front of link i
  std::vector<Marker<Link>> front = {}, middle = {}, rear = {};  ///< markers of each link: front pin, middle, rear pin

  /// Appends `link` with its pins and its middle, and the frames of these points to `track`.
  void add(LinkOf<Link> const& of, BodyHandle<Link> const& link, Track& track) {
    links.push_back(link);
    front.push_back(of.front(link));
    middle.push_back(of.middle(link));
    rear.push_back(of.rear(link));
    track.front.push_back(frame_in(link, front.back()));
    track.middle.push_back(frame_in(link, middle.back()));
    track.rear.push_back(frame_in(link, rear.back()));
  }
};

namespace detail {

/// Adds the 64 links of one side, with names that begin with `name`.
template <class Link>
[[gnu::cold]] void add_links(Subassembly<Bodies<Link>>& part, LinkOf<Link> const& of_links, Side s,
                             VehicleOptions const& options, LinkParts<Link>& parts, Track& track) {
  std::string const name = s == Side::left ? "left link " : "right link ";
  for (int i = 0; i < links; ++i) {
    Placement const place = options.start.links[std::size_t(i)].placement(sign(s) * track_y);
    Link const link = of_links.make(options.masses.link, place, options.link_elements);
    parts.add(of_links, part.add(link, name + std::to_string(i)), track);
  }
}

}  // namespace detail

}  // namespace polybody::m113
