#pragma once
#include <string>
#include <utility>

#include <polybody/bodies/shared/body.hpp>
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// A body formulation with the mesh that belongs to it, in the place of the body in a `Formulation`: a cable of so many
/// elements, a floating frame with so many modes.
template <Body B, int count>
  requires(count > 0)
struct Meshed {
  using BodyType = B;                     ///< without its mesh
  static constexpr int elements = count;  ///< the second argument of `from`
};

namespace detail {
/// What a formulation names as its body: a body itself, or one with a mesh.
template <class B>
struct MeshOf {
  using BodyType = B;
};
template <class B, int count>
struct MeshOf<Meshed<B, count>> : Meshed<B, count> {};
}  // namespace detail

/// One choice of each: how bodies are described, how joints are enforced, how time is integrated.
/// `compare` runs one case under several of them, one line each:
///
///     using Ideal = Formulation<planar::Rigid, Constraint, GeneralizedAlpha>;
///     using Cable = Formulation<Meshed<planar::AncfCable<>, 8>, Constraint, GeneralizedAlpha>;
///     compare<Ideal, Cable>([](auto const& choice) { … model.add(choice.body(bar), "rod") … });
template <class B, Policy P, class I>
  requires Body<typename detail::MeshOf<B>::BodyType>
struct Formulation {
  using BodyType = typename detail::MeshOf<B>::BodyType;  ///< the body without its mesh
  using PolicyType = P;                                   ///< how joints are enforced
  using IntegratorType = I;                               ///< how time is integrated

  std::string name;   ///< in the report
  P policy = {};      ///< for the joints of the case
  I integrator = {};  ///< with its options

  /// The body made `from` what it is given, `shape`, such as a bar, and then the number of elements of a `Meshed` one,
  /// and `others`.
  template <class Shape, class... Others>
  static BodyType body(Shape const& shape, Others&&... others) {
    if constexpr (requires { detail::MeshOf<B>::elements; })
      return BodyType::from(shape, detail::MeshOf<B>::elements, std::forward<Others>(others)...);
    else
      return BodyType::from(shape, std::forward<Others>(others)...);
  }
};

}  // namespace polybody
