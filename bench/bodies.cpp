// Every body formulation: time of the residual M a − f and of its tangent for all elements of a body. Counters: number
// of elements (Rigid, Ffr: one), nanoseconds per element, and for the residual the number of operations per element and
// their rate. A counting scalar counts each +, −, ×, ÷, root or sine as one operation.
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include "registered.hpp"

namespace {

/// Number that counts the operations on numbers of its type.
struct Counted {
  double x = 0.0;
  static inline long operations = 0;

  Counted() = default;
  Counted(double value) : x(value) {}  // NOLINT(google-explicit-constructor): a constant is a number
  static Counted done(double value) {
    ++operations;
    return value;
  }
  friend Counted operator+(Counted a, Counted b) { return done(a.x + b.x); }
  friend Counted operator-(Counted a, Counted b) { return done(a.x - b.x); }
  friend Counted operator*(Counted a, Counted b) { return done(a.x * b.x); }
  friend Counted operator/(Counted a, Counted b) { return done(a.x / b.x); }
  friend Counted operator-(Counted a) { return done(-a.x); }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  Counted& operator/=(Counted b) { return *this = *this / b; }
  friend Counted sqrt(Counted a) { return done(std::sqrt(a.x)); }
  friend Counted sin(Counted a) { return done(std::sin(a.x)); }
  friend Counted cos(Counted a) { return done(std::cos(a.x)); }
  friend Counted atan(Counted a) { return done(std::atan(a.x)); }
  friend Counted atan2(Counted a, Counted b) { return done(std::atan2(a.x, b.x)); }
  friend double value_of(Counted a) { return a.x; }
};

}  // namespace

template <>
struct Eigen::NumTraits<Counted> : Eigen::NumTraits<double> {
  using Real = Counted;
  using NonInteger = Counted;
  using Nested = Counted;
  using Literal = double;
};
template <class Operation>
struct Eigen::ScalarBinaryOpTraits<Counted, double, Operation> {
  using ReturnType = Counted;
};
template <class Operation>
struct Eigen::ScalarBinaryOpTraits<double, Counted, Operation> {
  using ReturnType = Counted;
};

namespace {

using namespace polybody;

Bar bar() {
  return {.length = 4.0,
          .section = Rectangle{.height = 0.03, .width = 0.02},
          .material = Material{.density = 7800.0, .young = 2e11, .poisson = 0.3}};
}

Bar damped_bar() {
  Bar damped = bar();
  damped.damping = {.axial = 1e-4, .shear = 2e-4, .bending = 3e-4};
  return damped;
}

template <class V>
auto span(V const& x) {
  return std::span<typename V::Scalar const>(x.data(), std::size_t(x.size()));
}

/// Deformed and moving state of a body.
struct Motion {
  VecX q, v, a;

  template <class B>
  explicit Motion(B const& body) : q(body.coordinates()), v(body.velocities()), a(v) {
    VecX reference(q.size()), delta(v.size());
    body.reference({reference.data(), std::size_t(reference.size())});
    for (Index i = 0; i < delta.size(); ++i) {
      delta[i] = 1e-3 * std::sin(7.0 * double(i));
      v[i] = 0.1 * std::sin(3.0 * double(i));
      a[i] = std::cos(5.0 * double(i));
    }
    body.template plus<double>(span(reference), span(delta), {q.data(), std::size_t(q.size())});
  }
};

/// Number of operations of M a − f for one element.
template <class B>
double operations_of(B const& body, Motion const& at) {
  VecXOf<Counted> const q = at.q.cast<Counted>(), v = at.v.cast<Counted>(), a = at.a.cast<Counted>();
  ForceScratch<B, Counted> counted(body);
  Counted::operations = 0;
  body.template inertia<Counted>(0, span(q), span(a), counted.x);
  body.template force<Counted>(0, span(q), span(v), counted.force);
  return double(Counted::operations) + double(element_columns(body));
}

/// Times `pass` over all elements.
template <class F>
void time_passes(benchmark::State& state, Index elements, F const& pass) {
  for (auto _ : state) pass();
  state.counters["elements"] = double(elements);
  registered::count_ns(state, "ns_per_element", double(elements));
}

template <class B>
void add(std::string const& name, B const& body) {
  auto const use = [](Index, auto const& x) {  // uses all entries, so that the compiler cannot omit any
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  };
  Index const elements = body.elements();
  registered::add("residual/" + name, [=](benchmark::State& state) {
    Motion const at(body);
    ForceScratch<B, double> force(body);
    time_passes(state, elements, [&] {
      for_each_residual<B, double>(body, {0, elements}, {span(at.q), span(at.v), span(at.a)}, force, use);
    });
    double const operations = operations_of(body, at);
    state.counters["operations"] = operations;
    state.counters["operations_per_ns"] =
        benchmark::Counter(1e-9 * operations * double(elements), benchmark::Counter::kIsIterationInvariantRate);
  });
  registered::add("tangent/" + name, [=](benchmark::State& state) {
    Motion const at(body);
    TangentScratch<B> tangent(body);
    time_passes(state, elements, [&] {
      for_each_element_tangent<B>(body, {0, elements}, {span(at.q), span(at.v)}, {1.5, 0.1, 1.0}, tangent, use);
    });
  });
}

}  // namespace

int main(int argc, char** argv) {
  Index const n = 64;
  add("Rigid<>", Rigid<>::from(bar()));
  add("Rigid<EulerParameters>", Rigid<EulerParameters>::from(bar()));
  add("AncfCable<>", AncfCable<>::from(bar(), n));
  add("AncfBeam<ElasticLine>", AncfBeam<ElasticLine>::from(bar(), n));
  add("AncfBeam<Continuum<>>", AncfBeam<Continuum<>>::from(bar(), n));
  add("Lrvf<RelativeRotation>", Lrvf<>::from(bar(), n));
  add("Lrvf<Direct>", Lrvf<Direct>::from(bar(), n));
  add("Se3Beam", Se3Beam::from(bar(), n));
  add("Lrvf<RelativeRotation>/damped", Lrvf<>::from(damped_bar(), n));
  add("Se3Beam/damped", Se3Beam::from(damped_bar(), n));
  Structure const s = structure_of(bar(), 8);
  add("Ffr/modes:6", Ffr(s, fixed_interface_modes(s, 6)));
  add("Ffr/stiffening/modes:6", Ffr(s, fixed_interface_modes(s, 6), {.stiffening = true}));
  add("Ffr/nodal_coordinates:48", Ffr(s, nodal_coordinates(s)));
  add("planar::Rigid", planar::Rigid::from(bar()));
  add("planar::AncfCable<>", planar::AncfCable<>::from(bar(), n));
  add("planar::Lrvf", planar::Lrvf::from(bar(), n));
  add("planar::Se3Beam", planar::Se3Beam::from(bar(), n));
  add("planar::Lrvf/damped", planar::Lrvf::from(damped_bar(), n));
  add("planar::Se3Beam/damped", planar::Se3Beam::from(damped_bar(), n));
  add("planar::Ffr/nodal_coordinates:24", planar::Ffr::from(bar(), 8));
  return registered::run(argc, argv);
}
