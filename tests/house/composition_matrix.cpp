// The tables "Combinations" of docs/joints.md, computed from the concepts that Joint, Model::connect and simulate
// require.
//   composition_matrix FILE            fails if the block between the two marks in FILE differs
//   composition_matrix FILE --write    writes the block
// A new geometry, policy, body or integrator needs a line here.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

using namespace polybody;

namespace {

template <class T>
struct Type {
  char const* name;
};

using Laws = NonlinearBushing<LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw>;
/// Placeholder for `PenaltyPerEquation`, whose number of parameters is the number of equations of the geometry.
struct PerRow {};
template <class P, class G>
using PolicyFor = std::conditional_t<std::is_same_v<P, PerRow>, PenaltyPerEquation<constraint_equations<G>()>, P>;

auto const geometries = std::tuple(
    Type<Spherical>{"Spherical"}, Type<Revolute>{"Revolute"}, Type<RevolutePin>{"RevolutePin"},
    Type<Universal>{"Universal"}, Type<Cylindrical>{"Cylindrical"}, Type<Prismatic>{"Prismatic"}, Type<Screw>{"Screw"},
    Type<PlanarJoint>{"PlanarJoint"}, Type<PointOnLine>{"PointOnLine"}, Type<PointInPlane>{"PointInPlane"},
    Type<ConstantOrientation>{"ConstantOrientation"}, Type<ParallelAxes>{"ParallelAxes"},
    Type<PerpendicularAxes>{"PerpendicularAxes"}, Type<Weld>{"Weld"}, Type<RelativeCoordinates>{"RelativeCoordinates"},
    Type<Distance>{"Distance"}, Type<Gear>{"Gear"}, Type<RackAndPinion>{"RackAndPinion"},
    Type<RollingDisc>{"RollingDisc"}, Type<KnifeEdge>{"KnifeEdge"}, Type<PrescribedAngle<Ramp>>{"PrescribedAngle"},
    Type<PrescribedRate<Ramp>>{"PrescribedRate"}, Type<PrescribedDistance<Ramp>>{"PrescribedDistance"},
    Type<PrescribedTranslation<Ramp>>{"PrescribedTranslation"}, Type<planar::Revolute>{"planar::Revolute"},
    Type<planar::Prismatic>{"planar::Prismatic"}, Type<planar::Weld>{"planar::Weld"});

auto const policies =
    std::tuple(Type<Constraint>{"Constraint"}, Type<Penalty>{"Penalty"}, Type<PerRow>{"PenaltyPerEquation"},
               Type<Bushing>{"Bushing"}, Type<Laws>{"NonlinearBushing"}, Type<JointCoordinates>{"JointCoordinates"},
               Type<JointCoordinatesBy<joint_coordinates::ArticulatedBody>>{"JointCoordinatesBy<ArticulatedBody>"},
               Type<AncfLinear>{"AncfLinear"});

auto const bodies = std::tuple(
    Type<Rigid<>>{"Rigid<>"}, Type<Rigid<EulerParameters>>{"Rigid<EulerParameters>"}, Type<AncfCable<>>{"AncfCable"},
    Type<AncfBeam<ElasticLine>>{"AncfBeam<ElasticLine>"}, Type<AncfBeam<Continuum<>>>{"AncfBeam<Continuum>"},
    Type<Lrvf<RelativeRotation>>{"Lrvf<RelativeRotation>"}, Type<Lrvf<Direct>>{"Lrvf<Direct>"},
    Type<Se3Beam>{"Se3Beam"}, Type<Ffr>{"Ffr"}, Type<planar::Rigid>{"planar::Rigid"},
    Type<planar::AncfCable<>>{"planar::AncfCable"}, Type<planar::Lrvf>{"planar::Lrvf"},
    Type<planar::Se3Beam>{"planar::Se3Beam"}, Type<planar::Ffr>{"planar::Ffr"});

/// An integrator; `refuses` is the cell for models that it refuses for other reasons than their constraint equations.
template <class I>
struct Stepper {
  char const* name;
  char const* refuses = "";
};
auto const integrators = std::tuple(
    Stepper<GeneralisedAlpha>{"GeneralisedAlpha"}, Stepper<HhtAlpha>{"HhtAlpha"}, Stepper<Newmark>{"Newmark"},
    Stepper<Trapezoidal>{"Trapezoidal"}, Stepper<Radau>{"Radau", "t"}, Stepper<EnergyMomentum>{"EnergyMomentum", "e"},
    Stepper<EnergyDecaying>{"EnergyDecaying", "e"}, Stepper<RungeKutta4<>>{"RungeKutta4<>"},
    Stepper<DormandPrince<>>{"DormandPrince<>"}, Stepper<AdamsBashforthMoulton<>>{"AdamsBashforthMoulton<>"},
    Stepper<CentralDifference<>>{"CentralDifference<>"}, Stepper<RungeKutta4<Projection>>{"RungeKutta4<Projection>"},
    Stepper<RungeKutta4<Baumgarte>>{"RungeKutta4<Baumgarte>"},
    Stepper<RungeKutta4<NoStabilisation>>{"RungeKutta4<NoStabilisation>"},
    Stepper<RungeKutta4<CoordinatePartitioning>>{"RungeKutta4<CoordinatePartitioning>"},
    Stepper<DormandPrince<Projection>>{"DormandPrince<Projection>"},
    Stepper<AdamsBashforthMoulton<Projection>>{"AdamsBashforthMoulton<Projection>"},
    Stepper<CentralDifference<Projection>>{"CentralDifference<Projection>"},
    Stepper<SymplecticEuler>{"SymplecticEuler", "m"}, Stepper<Rattle>{"Rattle", "m"});

constexpr char const* yes = "✓";

template <class P, class G>
char const* policy_cell() {
  using Q = PolicyFor<P, G>;
  if constexpr (EnforceablePair<Q, G>)
    return yes;
  else if constexpr (!HolonomicOrConstrained<Q, G>)
    return "v";
  else if constexpr (!MeasurableGeometry<Q, G>)
    return "f";
  else if constexpr (!JointCoordinatesIfRequired<Q, G>)
    return "j";
  else if constexpr (!LinearIfRequired<Q, G>)
    return "l";
  else
    return "no";
}

/// Body B and the ground may be joined by geometry G and policy P.
template <class B, class G, class P>
concept Joinable = SameWorld<G, B, Ground> && EnforceablePair<PolicyFor<P, G>, G> && EliminableBody<PolicyFor<P, G>, B>;
/// … with the first marker on B; with the second.
template <class B, class G, class P>
concept First = Joinable<B, G, P> && SufficientFirstMarker<Joint<G, PolicyFor<P, G>>, B>;
template <class B, class G, class P>
concept Second = Joinable<B, G, P> && SufficientSecondMarker<Joint<G, PolicyFor<P, G>>, B>;

template <class B, class P, class... Gs>
char const* marker_cell(char const* refused) {
  constexpr bool first = (First<B, Gs, P> || ...), second = (Second<B, Gs, P> || ...);
  return first && second ? yes : second ? "2nd" : first ? "1st" : refused;
}

template <class M, class I>
char const* step_cell(Stepper<I> const& stepper) {
  if constexpr (CompatibleIntegrator<I, M>)
    return yes;
  else if constexpr (!ConstraintCompatible<I, M>)
    return "s";
  else
    return stepper.refuses;
}

/// A planar body that every integrator accepts, on a joint of policy P.
template <class P>
using Held = Model<Bodies<std::conditional_t<LinearPolicy<P>, planar::AncfCable<>, planar::Rigid>>,
                   Joints<Joint<planar::Revolute, PolicyFor<P, planar::Revolute>>>>;
using OnABlade = Model<Bodies<planar::Rigid>, Joints<Joint<KnifeEdge, Constraint>>>;

/// Rows of text. Equal columns are merged, and equal rows if `merges_rows`.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< the name, then a cell for each column
  bool merges_rows = false;

  template <class... Cells>
  void row(char const* name, Cells... cells) {
    rows.push_back({code(name), cells...});
  }
  template <class... Ts>
  void heads(std::tuple<Ts...> const& list) {
    std::apply([&](auto const&... t) { (columns.push_back(code(t.name)), ...); }, list);
  }
  static std::string code(std::string const& name) { return "`" + name + "`"; }

  void merge_columns() {
    for (std::size_t i = 0; i < columns.size(); ++i)
      for (std::size_t j = i + 1; j < columns.size();) {
        if (!std::all_of(rows.begin(), rows.end(), [&](auto const& r) { return r[i + 1] == r[j + 1]; })) {
          ++j;
          continue;
        }
        columns[i] += ", " + columns[j];
        columns.erase(columns.begin() + std::ptrdiff_t(j));
        for (auto& r : rows) r.erase(r.begin() + std::ptrdiff_t(j) + 1);
      }
  }
  void merge_rows() {
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = i + 1; j < rows.size();) {
        if (!std::equal(rows[i].begin() + 1, rows[i].end(), rows[j].begin() + 1)) {
          ++j;
          continue;
        }
        rows[i][0] += ", " + rows[j][0];
        rows.erase(rows.begin() + std::ptrdiff_t(j));
      }
  }
  std::string text(std::string const& corner) {
    merge_columns();
    if (merges_rows) merge_rows();
    std::string out = "| " + corner + " |";
    for (std::string const& c : columns) out += " " + c + " |";
    out += "\n|---|";
    for (std::size_t i = 0; i < columns.size(); ++i) out += "---|";
    for (auto const& r : rows) {
      out += "\n|";
      for (std::string const& cell : r) out += " " + cell + " |";
    }
    return out + "\n";
  }
};

template <class G>
void geometry_row(Table& by_policy, Table& by_body, Type<G> g) {
  std::apply([&]<class... Ps>(Type<Ps>...) { by_policy.row(g.name, policy_cell<Ps, G>()...); }, policies);
  std::apply(
      [&]<class... Bs>(Type<Bs>...) {
        by_body.row(g.name, marker_cell<Bs, Constraint, G>(SameWorld<G, Bs, Ground> ? "n" : "w")...);
      },
      bodies);
}
template <class P, class... Gs>
void policy_row(Table& by_body, Type<P> p, std::tuple<Type<Gs>...> const&) {
  std::apply(
      [&]<class... Bs>(Type<Bs>...) {
        by_body.row(p.name, marker_cell<Bs, P, Gs...>(JointCoordinatePolicy<P> ? "r" : "l")...);
      },
      bodies);
}
template <class I>
void integrator_row(Table& by_body, Table& by_policy, Stepper<I> const& i) {
  std::apply([&]<class... Bs>(Type<Bs>...) { by_body.row(i.name, step_cell<Model<Bodies<Bs>, Joints<>>>(i)...); },
             bodies);
  std::apply(
      [&]<class... Ps>(Type<Ps>...) { by_policy.row(i.name, step_cell<Held<Ps>>(i)..., step_cell<OnABlade>(i)); },
      policies);
}

std::string composition() {
  Table geometry_policy, geometry_body, policy_body{.merges_rows = true}, integrator_body{.merges_rows = true},
      integrator_policy{.merges_rows = true};
  for (Table* t : {&geometry_policy, &integrator_policy}) t->heads(policies);
  for (Table* t : {&geometry_body, &policy_body, &integrator_body}) t->heads(bodies);
  integrator_policy.columns.push_back("`Constraint` with nonholonomic equations");
  std::apply([&](auto... g) { (geometry_row(geometry_policy, geometry_body, g), ...); }, geometries);
  std::apply([&](auto... p) { (policy_row(policy_body, p, geometries), ...); }, policies);
  std::apply([&](auto const&... i) { (integrator_row(integrator_body, integrator_policy, i), ...); }, integrators);

  static_assert(ConstrainedCoordinates<Spherical>::needs == MarkerKind::frame);
  return geometry_policy.text("geometry") +
         "\nv: a compliant policy needs equations between positions, and the geometry has nonholonomic equations.\n"
         "f: a bushing needs the free directions of the geometry, which are not defined.\n"
         "j: the free motion of the geometry has no joint coordinates.\n"
         "l: the equations are not linear in the coordinates of ANCF bodies.\n\n" +
         geometry_body.text("geometry, with `Constraint`") +
         "\n✓: either marker.\n"
         "2nd: only the second marker.\n"
         "n: the markers of the body do not provide the axis or frame.\n"
         "w: the geometry is for the plane and the body for space, or vice versa.\n"
         "The ground can be used everywhere.\n"
         "A bushing needs a frame at its first marker.\n\n" +
         policy_body.text("policy, with at least one geometry") +
         "\nr: joint coordinates need a rigid body, a floating frame or nodes with frames, and "
         "`JointCoordinatesBy<ArticulatedBody>` needs rigid "
         "bodies.\n"
         "l: positions of points are not linear in the coordinates of the body.\n\n" +
         integrator_body.text("integrator") +
         "\ns: the method has no stabilisation, and the norm of Euler parameters is a constraint equation.\n"
         "m: the mass matrix is not constant.\n"
         "e: the mass matrix is not constant, or the mean force over a step does not exist.\n\n" +
         integrator_policy.text("integrator") +
         "\ns: the method has no stabilisation for constraint equations.\n"
         "m: the mass matrix of joint coordinates is not constant.\n"
         "e: the method needs joints without elimination and without nonholonomic equations, and forces that are "
         "linear in g and ġ.\n"
         "t: the method solves its three stages in one linear system, which `ArticulatedBody` cannot solve.\n";
}

std::string const begins = "<!-- composition begins: written by tests/house/composition_matrix.cpp -->\n",
                  ends = "<!-- composition ends -->\n";

}  // namespace

int main(int argc, char** argv) {
  bool const writes = argc == 3 && std::string(argv[2]) == "--write";
  if (argc != 2 && !writes) {
    std::fprintf(stderr, "usage: %s FILE [--write]\n", argv[0]);
    return 2;
  }
  std::ifstream in(argv[1], std::ios::binary);
  std::string const text{std::istreambuf_iterator<char>(in), {}};
  std::size_t const first = text.find(begins), last = text.find(ends);
  if (first == std::string::npos || last == std::string::npos || last < first) {
    std::fprintf(stderr, "%s: the marks around the block are missing:\n%s%s", argv[1], begins.c_str(), ends.c_str());
    return 1;
  }
  std::string const fresh = text.substr(0, first) + begins + "\n" + composition() + "\n" + text.substr(last);
  if (fresh == text) return 0;
  if (!writes) {
    std::fprintf(stderr,
                 "%s: the tables of what composes with what are not up to date. Refresh them by\n  %s %s --write\n",
                 argv[1], argv[0], argv[1]);
    return 1;
  }
  AtomicFile out(argv[1]);
  out.write(fresh);
  out.close();
}
