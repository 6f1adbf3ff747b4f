// A type-erased model, and a view of a model with some of its types: the same motion as that of the model itself.

#include <polybody/polybody.hpp>

#include <gtest/gtest.h>

namespace polybody {
namespace any_model_test {

using Pin = Joint<Revolute, Constraint>;
using Slide = Joint<Prismatic, Constraint>;
using Double = Model<Bodies<Rigid<>, AncfCable<>>, Joints<Pin, Slide>, Forces<SpringDamper>>;

Rigid<> rod() { return Rigid<>(2.0, Vec3(0.01, 0.2, 0.2).asDiagonal(), Placement::at(Vec3(0.5, 0, 0), Vec3(0, 0, 0))); }
Pin pin() { return {Revolute{.axis = Vec3::UnitY()}, {}}; }

/// A pendulum on a spring, built by the model itself or through a view of it.
template <class Builder>
BodyHandle<Rigid<>> hang(Builder& builder) {
  auto const body = builder.add(rod(), "rod");
  builder.connect(pin(), builder.ground().at({0, 0, 0}), body.at(Vec3(-0.5, 0, 0)), "pin");
  builder.apply(SpringDamper{.stiffness = 40.0, .damping = 0.5, .free_length = 1.0}, builder.ground().at({1, 0, 1}),
                body.at(Vec3(0.5, 0, 0)), "spring");
  return body;
}
template <class M>
State after_a_run(M const& model) {
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 5e-3}).run();
  return x;
}
bool same(State const& a, State const& b) {
  return a.t == b.t && a.q == b.q && a.v == b.v && a.a == b.a && a.lambda == b.lambda;
}
std::string refusal(auto&& call) {
  try {
    call();
  } catch (InvalidInput const& e) {
    return e.what();
  }
  return "";
}

TEST(Subassembly, BuildsWhatTheModelBuilds) {
  Double full{Gravity{0, 0, -9.81}}, in_parts{Gravity{0, 0, -9.81}};
  hang(full);
  Subassembly<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>> part(in_parts);
  BodyHandle<Rigid<>> const body = hang(part);
  EXPECT_EQ(in_parts.entry(body).name, "rod");
  EXPECT_TRUE(same(after_a_run(full), after_a_run(in_parts)));
}

TEST(Subassembly, RefusesWhatTheModelRefuses) {
  Double one, other;
  Subassembly<Bodies<Rigid<>>, Joints<Pin>> part(one);
  auto const body = part.add(rod(), "rod"), foreign = other.add(rod(), "rod");
  EXPECT_THROW(part.add(rod(), "rod"), InvalidInput);  // the name is in use
  EXPECT_NE(refusal([&] { part.connect(pin(), body.at(Vec3(0, 0, 0)), foreign.at(Vec3(0, 0, 0)), "pin"); }).find("pin"),
            std::string::npos);
  EXPECT_EQ(one.rows(), 0);
}

TEST(AnyModel, RunsAsItsModelDoes) {
  auto const model = std::make_shared<Double>(Gravity{0, 0, -9.81});
  BodyHandle<Rigid<>> const body = hang(*model);
  AnyModel const any(std::shared_ptr<Double const>(model), stepped_by<GeneralisedAlpha, Radau>);
  State const x = after_a_run(any);
  EXPECT_TRUE(same(x, after_a_run(*model)));
  EXPECT_EQ(problem_size(any).degrees_of_freedom, problem_size(*model).degrees_of_freedom);
  System asked = observation_system(any);
  asked.evaluate(x.q, x.v, x.t);
  EXPECT_EQ(energy(asked, x).total(), energy(*model, x).total());
  EXPECT_EQ(asked.layout().bodies[std::size_t(index_of(asked.layout(), body))].name, "rod");
  EnergyAudit audit(any.system());
  audit.record(any.reference_state());
  audit.record(x);
  EXPECT_EQ(audit.kinetic(), energy(*model, x).kinetic);
}

TEST(AnyModel, KeepsItsModel) {
  auto model = std::make_shared<Double>(Gravity{0, 0, -9.81});
  hang(*model);
  State const expected = after_a_run(*model);
  AnyModel const any(std::shared_ptr<Double const>(std::move(model)), stepped_by<GeneralisedAlpha>);
  EXPECT_TRUE(same(after_a_run(any), expected));
}

TEST(AnyModel, NamesTheIntegratorThatItWasMadeWithout) {
  auto const model = std::make_shared<Double const>();
  AnyModel const any(model, stepped_by<GeneralisedAlpha>);
  State x = any.reference_state();
  EXPECT_EQ(refusal([&] { simulate(any, x, Radau{}, {.end_time = 1.0, .step = 1e-2}); }),
            std::string("AnyModel was made without the integrator ") + Radau::name +
                ". Add this integrator to the list in AnyModel(model, stepped_by<...>).");
}

}  // namespace any_model_test
}  // namespace polybody
