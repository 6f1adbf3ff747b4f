#pragma once
/// \file
/// Formulation of a mechanism as one type: body formulation with its mesh, constraint policy and integrator.

#include <string>
#include <utility>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Body formulation with its mesh, for use as the body of a `Formulation`. `count` is the number of elements of a
/// cable, or the number of modes of a floating frame.
template <Body B, int count>
  requires(count > 0)
struct Meshed {
  using BodyType = B;                     ///< body without mesh
  static constexpr int elements = count;  ///< number of elements or modes, the second argument of `from`
};

/// Floating frame of a bar with `count` elements, reduced to the static shapes of its ends and `inner` modes between
/// them (the option `modes` of `Ffr`).
template <class B, int count, int inner>
  requires(count > 0 && inner >= 0)
struct Modal {
  using BodyType = B;                     ///< body without mesh
  static constexpr int elements = count;  ///< number of elements, the second argument of `from`
  static constexpr int modes = inner;     ///< number of modes between the ends
};

namespace detail {
/// Body type and mesh of a formulation's body: a body itself, or one with a mesh.
template <class B>
struct MeshOf {
  using BodyType = B;
};
template <class B, int count>
struct MeshOf<Meshed<B, count>> : Meshed<B, count> {};
template <class B, int count, int inner>
struct MeshOf<Modal<B, count, inner>> : Modal<B, count, inner> {};
}  // namespace detail

/// Formulation of a mechanism: a body formulation, a constraint policy and an integrator. `compare` runs one case
/// under several formulations, one line each:
///
///     using Ideal = Formulation<planar::Rigid, Constraint, GeneralisedAlpha>;
///     using Cable = Formulation<Meshed<planar::AncfCable<>, 8>, Constraint, GeneralisedAlpha>;
///     compare<Ideal, Cable>([](auto const& choice) { … model.add(choice.body(bar), "rod") … });
template <class B, Policy P, class I>
  requires Body<typename detail::MeshOf<B>::BodyType>
struct Formulation {
  using BodyType = typename detail::MeshOf<B>::BodyType;  ///< body formulation without mesh
  using PolicyType = P;                                   ///< policy that enforces the constraint equations of joints
  using IntegratorType = I;                               ///< numerical method for the equations of motion

  std::string name;   ///< name in the report
  P policy = {};      ///< policy of the case's joints
  I integrator = {};  ///< integrator with its options

  /// Creates the body by its function `from`. The arguments are `shape`, such as a bar, then the number of elements
  /// if the body is `Meshed` or `Modal`, and `others`.
  template <class Shape, class... Others>
  static BodyType body(Shape const& shape, Others&&... others) {
    using Mesh = detail::MeshOf<B>;
    constexpr bool is_modal = requires { Mesh::modes; }, is_meshed = requires { Mesh::elements; };
    if constexpr (is_modal)
      return BodyType::from(shape, Mesh::elements, typename BodyType::Options{.modes = Mesh::modes},
                            std::forward<Others>(others)...);
    else if constexpr (is_meshed)
      return BodyType::from(shape, Mesh::elements, std::forward<Others>(others)...);
    else
      return BodyType::from(shape, std::forward<Others>(others)...);
  }
};

}  // namespace polybody
