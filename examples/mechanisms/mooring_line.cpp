// Mooring line with its lower part on the sea bed: the pull at the fairlead is that of an elastic catenary.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Cable = AncfCable<EngineeringStrain>;
  using Ball = Joint<Spherical, Constraint>;
  using Bed = Contact<SphereOnPlane>;
  double const length = 902.2, weight = 698.094, EA = 384.243e6;  // in water, per length [N/m]
  Vec3 const fairlead(848.67, 0, 250);
  Index const elements = 40;
  Bar const bar{.length = length, .constants = BarConstants{.EA = EA, .EI = 1.0, .mass_per_length = weight / 9.81}};
  Model<Bodies<Cable>, Joints<Ball>, Forces<Bed>> model{Gravity{0, 0, -9.81}};
  auto const line = model.add(Cable::from(bar, elements, catenary(fairlead, length, {0, 0, -1})), "line");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), line.at(0.0), "anchor");
  auto const end = model.connect(Ball{}, model.ground().at(fairlead), line.at(length), "fairlead");
  // Each node is a ball on the bed, which it presses in by 1 mm.
  double const element = length / double(elements), radius = 0.05;
  Bed const bed{.geometry = {.radius = radius}, .normal = {.stiffness = weight * element / 1e-3, .damping = 0.0}};
  for (Index i = 0; i <= elements; ++i)
    model.apply(bed, line.at(element * double(i)), model.ground().at({0, 0, -radius}));
  State x = model.reference_state();
  equilibrium(model, x);

  // Part V/w hangs: z = (√(H² + V²) − H)/w + V²/(2 w EA), x = L − V/w + (H/w) asinh(V/H) + H L/EA [Jonkman 2007].
  double low = 1e4, high = 1e7, lift = 0.0;
  for (int i = 0; i < 100; ++i) {
    double const pull = 0.5 * (low + high);
    double least = 0.0, most = weight * length;
    for (int k = 0; k < 100; ++k) {
      lift = 0.5 * (least + most);
      double const z = (std::hypot(pull, lift) - pull + 0.5 * lift * lift / EA) / weight;
      (z > fairlead[2] ? most : least) = lift;
    }
    double const reach = length - lift / weight + pull / weight * std::asinh(lift / pull) + pull * length / EA;
    (reach > fairlead[0] ? high : low) = pull;
  }
  mechanism::Picture picture("Mooring line", 0, 2);
  std::vector<Vec3> shape;
  for (int i = 0; i <= 100; ++i) shape.push_back(position(model, x, line.at(length * i / 100)));
  picture.line({Vec3(0, 0, 0), Vec3(fairlead[0], 0, 0)}, 1);
  picture.line(shape, 0);
  picture.text({600, 0, 0}, "sea bed");
  picture.text({0, 0, 0}, "anchor");
  picture.text({690, 0, 255}, "fairlead");
  picture.line({Vec3(length - lift / weight, 0, 0)}, 2);
  picture.text({110, 0, -60}, "touch-down");
  picture.write("mooring_line");
  double const pull = std::abs(reaction(model, x, end).f[0]);
  return mechanism::compare("horizontal pull [kN]", 1e-3 * pull, 1e-3 * low, 1e-3 * 2e-3 * low);
}
