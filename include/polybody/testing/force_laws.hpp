#pragma once
/// \file
/// Tests of properties that every force element has, such as derivatives, balance and energy: `ForceLaws`.
///
/// Requires GoogleTest.

#include <polybody/testing/force_differences.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Laws that every force element satisfies. A case gives the element and the frames of its markers:
///
///     struct SpringCase {
///       static SpringDamper force();
///       static std::array<Frame<double>, 2> frames(Numbers&);  // optional; the default is random frames
///       static std::array<double, 1> states(Numbers&);         // optional; the default is random numbers in [−1, 1]
///     };
///     bool const spring_obeys = obeys<SpringCase, ForceLaws>("Spring");
template <class Case>
struct ForceLaws {
  using F = decltype(Case::force());  ///< type of the element
  static constexpr int markers = F::markers;
  using Frames = std::array<Frame<double>, std::size_t(markers)>;  ///< frame of each marker
  static constexpr bool internal = markers > 1 && !F::is_load;  ///< true if the element acts between its markers only
  static constexpr bool stores = HasPotential<F> || HasStatePotential<F>;  ///< true if the element has a potential

  F const force = Case::force();                                            ///< element under test
  double const t = 1.3;                                                     ///< time of the evaluation [s]
  Numbers number;                                                           ///< random numbers with a fixed seed
  std::array<double, std::size_t(states_of<F>())> const z = some_states();  ///< first-order states of the element

  /// Frames of the markers from the case, or random frames if the case has no function `frames`.
  Frames frames() {
    if constexpr (requires { Case::frames(number); }) {
      return Case::frames(number);
    } else {
      Frames all;
      for (Frame<double>& f : all) f = number.frame();
      return all;
    }
  }
  using States = std::array<double, std::size_t(states_of<F>())>;  ///< first-order states
  /// States from the case, or random states in [−1, 1] if the case has no function `states`.
  States some_states() {
    if constexpr (requires { Case::states(number); }) return Case::states(number);
    States some{};
    for (double& x : some) x = number();
    return some;
  }
  /// The element; an element with first-order states is bound to the states z.
  auto law() const {
    if constexpr (HasStates<F>)
      return AtStates<F, double>{force, z};
    else
      return force;
  }
  /// Column of the wrenches [f; m] on all markers, followed by the rates of the states.
  VecX stacked(Frames const& f) const {
    if constexpr (HasStates<F>)
      return stacked_answer(force, f, z, t);
    else
      return stacked_wrenches(force, f, t);
  }
  std::array<Wrench<double>, std::size_t(markers)> wrenches(Frames const& f) const {
    return law().template wrenches<double>(f, t);
  }
  /// Required kinematics of marker number `marker`.
  static MarkerKind needs(int marker) { return marker == 1 ? needs_of_second<F>() : F::needs; }

  /// `wrench_gradient` equals ck ∂w/∂pose + cd ∂w/∂twist of the wrenches w, computed by differences. For elements with
  /// states, `gradient_with_states` is compared. The test detects derivatives that the element loses by a branch or by
  /// a conversion to double.
  void gradient_is_the_derivative_of_the_wrenches() {
    for (auto const& [ck, cd] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.7, 31.0}})
      if constexpr (HasStates<F>) {
        Frames const f = frames();
        MatX const expected = gradient_by_differences(force, f, z, t, {ck, cd, 1.0 + cd});
        MatX const given = gradient_with_states(force, f, z, t, {ck, cd, 1.0 + cd});
        EXPECT_LT((given - expected).cwiseAbs().maxCoeff(), 1e-7 * (1.0 + expected.cwiseAbs().maxCoeff()))
            << ck << ' ' << cd;
      } else {
        EXPECT_LT(gradient_mismatch(force, frames(), t, ck, cd), 1e-7) << ck << ' ' << cd;
      }
  }

  /// If the element requires only the point of a marker, wrenches and rates do not depend on the axes and the angular
  /// velocity of this marker, and the moment on it is zero.
  void asks_no_more_than_it_says() {
    Frames const given = frames();
    Frames turned = given;
    for (int k = 0; k < markers; ++k)
      if (needs(k) == MarkerKind::point) {
        turned[std::size_t(k)].A = exp_so3<double>(number.template vec<3>(2.0));
        turned[std::size_t(k)].w = number.template vec<3>();
      }
    EXPECT_EQ(stacked(turned), stacked(given));
    for (int k = 0; k < markers; ++k)
      if (needs(k) == MarkerKind::point) {
        EXPECT_EQ(wrenches(given)[std::size_t(k)].m.norm(), 0.0);
      }
  }

  /// Σ f = 0 and Σ (m + r × f) = 0 for an element between two or more markers that is not a load.
  void action_is_reaction() {
    Frames const f = frames();
    auto const w = wrenches(f);
    Vec3 force_sum = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0.0;
    for (std::size_t k = 0; k < w.size(); ++k) {
      force_sum += w[k].f;
      moment += w[k].m + f[k].r.cross(w[k].f);
      size += w[k].f.norm() + w[k].m.norm();
    }
    EXPECT_GT(size, 0.0);
    EXPECT_LT(force_sum.norm(), 1e-13 * size);
    EXPECT_LT(moment.norm(), 1e-12 * size);
  }

  /// If an element acts between its markers only, a rotation and displacement of all frames and twists rotates the
  /// wrenches and does not change the rates of the states.
  void rigid_motion_turns_the_wrenches() {
    Frames const f = frames();
    Mat3 const turn = exp_so3<double>(number.template vec<3>(2.0));
    Vec3 const shift = number.template vec<3>(4.0);
    Frames elsewhere;
    for (std::size_t k = 0; k < f.size(); ++k) elsewhere[k] = carried(f[k], turn, shift);
    auto const before = wrenches(f), after = wrenches(elsewhere);
    double const size = 1.0 + stacked(f).norm();
    for (std::size_t k = 0; k < f.size(); ++k) {
      EXPECT_LT((after[k].f - turn * before[k].f).norm(), 1e-12 * size);
      EXPECT_LT((after[k].m - turn * before[k].m).norm(), 1e-12 * size);
    }
    Index const states = states_of<F>();
    EXPECT_LT((stacked(elsewhere).tail(states) - stacked(f).tail(states)).norm(), 1e-12 * size);
  }

  /// Stored energy at the frames f and the states y.
  double energy(Frames const& f, States const& y) const {
    if constexpr (HasStates<F>)
      return force.potential(f, y, t);
    else
      return force.potential(f, t);
  }
  /// Power Σ w·V of the element bound to the states z, with the twists V of the frames f.
  double power(Frames const& f, Frames const& with_twists) const {
    double sum = 0.0;
    auto const w = wrenches(f);
    for (std::size_t k = 0; k < f.size(); ++k) sum += w[k].f.dot(with_twists[k].v) + w[k].m.dot(with_twists[k].w);
    return sum;
  }
  /// Rate of the stored energy along the twists of the frames f and the rates of the states.
  double energy_rate(Frames const& f) const {
    return slope_at_zero(
        [&](double h) {
          Frames near = f;
          for (Frame<double>& x : near) x = later(x, h);
          States y = z;
          if constexpr (HasStates<F>) {
            auto const rates = force.template rates<double>(f, z, t);
            for (std::size_t s = 0; s < y.size(); ++s) y[s] += h * rates[s];
          }
          return energy(near, y);
        },
        1e-4);
  }
  /// Frames with zero twists.
  static Frames at_rest(Frames f) {
    for (Frame<double>& x : f) x.v = x.w = Vec3::Zero();
    return f;
  }

  /// w = −∂U/∂pose − (∂ż/∂V)ᵀ ∂U/∂z at rest, for an element with a potential U. The last term exists for states z whose
  /// rates depend on the twists V.
  void wrenches_at_rest_are_the_slope_of_the_potential() {
    if constexpr (stores) {
      Frames const f = at_rest(frames());
      VecX const w = stacked(f).head(6 * markers);
      if (energy(f, z) != 0.0) {
        EXPECT_GT(w.norm(), 0.0);
      }
      VecX by_states = VecX::Zero(6 * markers);
      if constexpr (HasStates<F>) {
        auto const gradient = gradient_with_states(force, f, z, t, {0.0, 1.0, 0.0});
        for (std::size_t s = 0; s < z.size(); ++s) {
          double const slope = slope_at_zero([&](double h) {
            States near = z;
            near[s] += h;
            return energy(f, near);
          });
          for (Index j = 0; j < 6 * markers; ++j) by_states[j] += slope * gradient(6 * markers + Index(s), j);
        }
      }
      for (Index j = 0; j < w.size(); ++j) {
        double const slope = slope_at_zero([&](double h) {
          Frames near = f;
          Frame<double>& one = near[std::size_t(j / 6)];
          one = moved<double>(one, Vec6(Vec6::Unit(j % 6) * h));
          return energy(near, z);
        });
        EXPECT_NEAR(w[j], -slope - by_states[j], 1e-7 * (1.0 + w.norm())) << j;
      }
    }
  }

  /// Σ w·V ≤ −U˙ for an element with a potential U, with wrenches w and twists V: its power does not exceed the release
  /// of stored energy.
  void gives_back_no_more_than_its_potential() {
    if constexpr (stores) {
      for (int i = 0; i < 10; ++i) {
        Frames const f = frames();
        double const given = power(f, f);
        EXPECT_LT(given + energy_rate(f), 1e-6 * (1.0 + std::abs(given)));
      }
    }
  }

  /// `dissipation` = −(w₀·V + U˙) for an element with states and a potential U, with the wrenches w₀ at rest.
  void dissipation_is_the_lost_power() {
    if constexpr (HasStatePotential<F>) {
      for (int i = 0; i < 10; ++i) {
        Frames const f = frames();
        double const lost = -power(at_rest(f), f) - energy_rate(f);
        EXPECT_NEAR(force.dissipation(f, z, t), lost, 1e-6 * (1.0 + std::abs(lost)));
      }
    }
  }

  static constexpr char const* suite = "ForceLaws";
  static constexpr Law<ForceLaws> laws[] = {
      {"GradientIsTheDerivativeOfTheWrenches", &ForceLaws::gradient_is_the_derivative_of_the_wrenches},
      {"AsksNoMoreThanItSays", &ForceLaws::asks_no_more_than_it_says},
      {"ActionIsReaction", &ForceLaws::action_is_reaction, internal},
      {"RigidMotionTurnsTheWrenches", &ForceLaws::rigid_motion_turns_the_wrenches, internal},
      {"WrenchesAtRestAreTheSlopeOfThePotential", &ForceLaws::wrenches_at_rest_are_the_slope_of_the_potential, stores},
      {"GivesBackNoMoreThanItsPotential", &ForceLaws::gives_back_no_more_than_its_potential, stores},
      {"DissipationIsTheLostPower", &ForceLaws::dissipation_is_the_lost_power, HasStatePotential<F>}};
};

}  // namespace polybody::laws
