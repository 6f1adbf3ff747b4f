#pragma once
// Contact points between two frames, collected and checked.
#include <gtest/gtest.h>

#include <vector>

#include <polybody/forces/contact.hpp>
#include <polybody/testing/differences.hpp>

namespace polybody {

template <class G>
std::vector<ContactPoint<double>> contact_points(G const& geometry, Frame<double> const& a, Frame<double> const& b) {
  std::vector<ContactPoint<double>> found;
  geometry.template for_each_point<double>(a, b, [&](ContactPoint<double> const& p) { found.push_back(p); });
  return found;
}

/// Derivatives of contact points by dual numbers against differences, for a link with the velocity `motion`:
/// position, normal, depth and share. \return their number
template <class G>
int expect_contact_duals(G const& geometry, Frame<double> const& link, Frame<double> const& other, Vec6 const& motion) {
  using D = Dual<1>;
  auto const stacked = [](auto const& found) {
    using T = std::decay_t<decltype(found[0].depth)>;
    Vec<T, Eigen::Dynamic> all(Index(8 * found.size()));
    for (std::size_t i = 0; i < found.size(); ++i)
      all.template segment<8>(Index(8 * i)) << found[i].place, found[i].normal, found[i].depth, found[i].handover.share;
    return all;
  };
  std::vector<ContactPoint<D>> found;
  geometry.template for_each_point<D>(laws::moved<D>(link, motion.cast<D>() * D::variable(0.0, 0)),
                                      laws::moved<D>(other, Vec<D, 6>::Zero()),
                                      [&](ContactPoint<D> const& p) { found.push_back(p); });
  VecX const slope = laws::slope_at_zero(
      [&](double h) {
        return VecX(stacked(contact_points(geometry, laws::moved<double>(link, Vec6(motion * h)), other)));
      },
      1e-6);
  auto const all = stacked(found);
  EXPECT_EQ(all.size(), slope.size());
  for (Index i = 0; i < std::min(all.size(), slope.size()); ++i)
    EXPECT_NEAR(all[i].d[0], slope[i], 1e-8 * (1.0 + std::abs(slope[i])));
  return int(found.size());
}

}  // namespace polybody
