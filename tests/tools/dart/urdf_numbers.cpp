// Numbers of the robots in tests/unit/io/urdf by DART 6.12 (Debian: libdart-utils-urdf-dev), which shares no code with
// polybody:
//   urdf_numbers FOLDER             writes FOLDER/NAME.dart for each robot
//   urdf_numbers FOLDER --check     compares the files with new numbers
// A file gives the motion of the joints, the mass, and for each link the frame, velocities and accelerations, in world
// axes with gravity (0, 0, −9.81) m/s². Damping acts as a force −d q̇. The closed four-bar linkage is solved with mass
// matrix M, forces h and Jacobian G of DART:  M q̈ + h = Gᵀλ,  G q̈ = −Ġ q̇.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>

#include <dart/dart.hpp>
#include <dart/utils/urdf/urdf.hpp>

namespace {

using dart::dynamics::BodyNode;
using dart::dynamics::FreeJoint;
using dart::dynamics::Skeleton;
using Eigen::Vector3d;

std::ostream& operator<<(std::ostream& out, Vector3d const& v) {
  return out << ' ' << v[0] << ' ' << v[1] << ' ' << v[2];
}

/// Motion of all joints: sums without a pattern. Viscous damping acts as an applied force.
void move(Skeleton& robot, std::vector<double> const& damping) {
  for (std::size_t i = 0; i < robot.getNumDofs(); ++i) {
    auto* const dof = robot.getDof(i);
    if (dynamic_cast<FreeJoint*>(dof->getJoint())) continue;
    dof->setPosition(0.6 * std::sin(1.7 * double(i) + 0.4));
    dof->setVelocity(1.5 * std::cos(2.3 * double(i) + 0.2));
    dof->setForce(-damping[i] * dof->getVelocity());
  }
  if (auto* const root = dynamic_cast<FreeJoint*>(robot.getRootJoint())) {
    Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
    at.translate(Vector3d(0.3, -0.2, 0.5));
    at.rotate(Eigen::AngleAxisd(0.8, Vector3d(0.2, -0.6, 0.5).normalized()));
    root->setTransform(at);
    root->setLinearVelocity(Vector3d(0.4, -0.3, 0.2));
    root->setAngularVelocity(Vector3d(-0.7, 0.5, 1.1));
  }
}

/// Position of the end of the coupler relative to the end of the rocker, in the plane of motion.
Eigen::Vector2d gap(Skeleton& robot) {
  Vector3d const d = robot.getBodyNode("coupler")->getWorldTransform() * Vector3d(0.6, 0, 0) -
                     robot.getBodyNode("rocker")->getWorldTransform() * Vector3d(0.45, 0, 0);
  return {d.x(), d.z()};
}
/// Rows x and z of a Jacobian of the gap, from those of the two points.
Eigen::MatrixXd gap_rows(Eigen::MatrixXd const& coupler, Eigen::MatrixXd const& rocker) {
  Eigen::MatrixXd const all = coupler - rocker;
  Eigen::MatrixXd rows(2, all.cols());
  rows << all.row(0), all.row(2);
  return rows;
}
Eigen::MatrixXd gap_jacobian(Skeleton& robot) {
  return gap_rows(robot.getLinearJacobian(robot.getBodyNode("coupler"), Vector3d(0.6, 0, 0)),
                  robot.getLinearJacobian(robot.getBodyNode("rocker"), Vector3d(0.45, 0, 0)));
}

/// Closes the loop at the position and rate of the crank, and sets the accelerations.
void close(Skeleton& robot) {
  for (int k = 0; k < 40; ++k) {
    Eigen::VectorXd q = robot.getPositions();
    Eigen::MatrixXd const g = gap_jacobian(robot);
    Eigen::Vector2d const step = g.rightCols(2).lu().solve(gap(robot));
    q.tail(2) -= step;
    robot.setPositions(q);
  }
  Eigen::MatrixXd const g = gap_jacobian(robot);
  Eigen::VectorXd v = robot.getVelocities();
  v.tail(2) = -g.rightCols(2).lu().solve(g.leftCols(1) * v[0]);
  robot.setVelocities(v);
  Eigen::MatrixXd const rate =
      gap_rows(robot.getLinearJacobianDeriv(robot.getBodyNode("coupler"), Vector3d(0.6, 0, 0)),
               robot.getLinearJacobianDeriv(robot.getBodyNode("rocker"), Vector3d(0.45, 0, 0)));
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(5, 5);
  all.topLeftCorner(3, 3) = robot.getMassMatrix();
  all.topRightCorner(3, 2) = -g.transpose();
  all.bottomLeftCorner(2, 3) = g;
  Eigen::VectorXd right(5);
  right << robot.getForces() - robot.getCoriolisAndGravityForces(), -rate * v;
  robot.setAccelerations(all.fullPivLu().solve(right).head(3));
}

std::string numbers(std::string const& file) {
  auto const robot = dart::utils::DartLoader().parseSkeleton(file);
  if (!robot) throw std::runtime_error(file + " was not read");
  if (auto* const tool = robot->getBodyNode("tool")) tool->remove();  // DART gives a link without mass the mass 1 kg
  robot->setGravity({0, 0, -9.81});
  std::vector<double> damping;
  for (std::size_t i = 0; i < robot->getNumDofs(); ++i) {
    damping.push_back(robot->getDof(i)->getDampingCoefficient());
    robot->getDof(i)->setDampingCoefficient(0.0);
    robot->getDof(i)->setCoulombFriction(0.0);
  }
  move(*robot, damping);
  bool const loop = robot->getName() == "four_bar";
  if (loop) {
    move(*robot, damping);
    close(*robot);
    for (std::size_t i = 0; i < 3; ++i) robot->getDof(i)->setForce(-damping[i] * robot->getDof(i)->getVelocity());
    close(*robot);
  } else {
    robot->computeForwardDynamics();
  }
  std::ostringstream out;
  out.precision(17);
  out << "mass " << robot->getMass() << robot->getCOM() << '\n';
  for (std::size_t i = 0; i < robot->getNumDofs(); ++i)
    if (auto* const dof = robot->getDof(i); !dynamic_cast<FreeJoint*>(dof->getJoint()))
      out << "joint " << dof->getJoint()->getName() << ' ' << dof->getPosition() << ' ' << dof->getVelocity() << ' '
          << dof->getAcceleration() << '\n';
  for (std::size_t i = 0; i < robot->getNumBodyNodes(); ++i) {
    BodyNode const& body = *robot->getBodyNode(i);
    Eigen::Isometry3d const& at = body.getWorldTransform();
    out << "link " << body.getName() << Vector3d(at.translation()) << Vector3d(at.linear().col(0))
        << Vector3d(at.linear().col(1)) << Vector3d(at.linear().col(2)) << body.getLinearVelocity()
        << body.getAngularVelocity() << body.getCOMLinearAcceleration() << body.getAngularAcceleration() << '\n';
  }
  return out.str();
}

/// Largest difference of the numbers of two texts with the same words; a large number if the words differ.
double difference(std::string const& a, std::string const& b) {
  std::istringstream first(a), second(b);
  double worst = 0.0;
  for (std::string x, y; first >> x;) {
    if (!(second >> y)) return 1e300;
    char *end_x = nullptr, *end_y = nullptr;
    double const u = std::strtod(x.c_str(), &end_x), v = std::strtod(y.c_str(), &end_y);
    if (*end_x || *end_y) {
      if (x != y) return 1e300;
    } else {
      worst = std::max(worst, std::abs(u - v) / std::max(1.0, std::abs(v)));
    }
  }
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::cerr << "urdf_numbers FOLDER [--check]\n", 2;
  std::string const folder = std::string(argv[1]) + '/';
  int failed = 0;
  for (std::string const name : {"six_axes", "four_bar", "quadruped"}) {
    std::string const text = numbers(folder + name + ".urdf"), file = folder + name + ".dart";
    if (argc > 2 && !std::strcmp(argv[2], "--check")) {
      std::ostringstream stored;
      stored << std::ifstream(file).rdbuf();
      double const off = difference(text, stored.str());
      std::cout << name << ": largest difference " << off << '\n';
      failed += !(off < 1e-11);
    } else {
      std::ofstream(file) << text;
    }
  }
  return failed;
}
