#include "rig.hpp"

#include <Simbody.h>

#include <cmath>

namespace crosscheck {
namespace {

using namespace SimTK;

// One gimbal angle with its derivatives, as Simbody wants a function of time.
class Angle : public Function {
 public:
  Angle(const Rig& rig, int axis) : rig_(rig), axis_(axis) {}

  Real calcValue(const Vector& t) const override { return rig_.angle(t[0], axis_, 0); }
  Real calcDerivative(const Array_<int>& components, const Vector& t) const override {
    return rig_.angle(t[0], axis_, static_cast<int>(components.size()));
  }
  int getArgumentSize() const override { return 1; }
  int getMaxDerivativeOrder() const override { return 2; }

 private:
  const Rig& rig_;
  int axis_;
};

}  // namespace

std::vector<std::array<double, 2>> simulate(const Rig& rig, const std::vector<double>& times) {
  MultibodySystem system;
  SimbodyMatterSubsystem matter(system);
  GeneralForceSubsystem forces(system);
  Force::Gravity gravity(forces, matter, Vec3(0, 0, -rig.gravity));

  // A pin turns about the z axis of its frames: turn that to the y axis, then to the x axis.
  const Body::Rigid frame_body(MassProperties(1, Vec3(0), Inertia(1)));
  const Transform about_y(Rotation(-Pi / 2, XAxis)), about_x(Rotation(Pi / 2, YAxis));
  MobilizedBody::Pin outer(matter.Ground(), about_y, frame_body, about_y);
  MobilizedBody::Pin plate(outer, about_x, frame_body, about_x);
  const double r = rig.radius, m = rig.mass;
  const Body::Rigid ball(MassProperties(m, Vec3(0), Inertia(0.4 * m * r * r)));
  MobilizedBody::Free sphere(matter.Ground(), Transform(), ball, Transform());
  Constraint::PrescribedMotion phi(matter, new Angle(rig, 0), outer, MobilizerQIndex(0));
  Constraint::PrescribedMotion theta(matter, new Angle(rig, 1), plate, MobilizerQIndex(0));
  Constraint::SphereOnPlaneContact rolling(plate, Transform(), sphere, Vec3(0), r, true);

  State state = system.realizeTopology();
  const double phi_0 = rig.angle(0, 0, 0), phi_rate = rig.angle(0, 0, 1);
  const double theta_0 = rig.angle(0, 1, 0), theta_rate = rig.angle(0, 1, 1);
  outer.setAngle(state, phi_0);
  outer.setRate(state, phi_rate);
  plate.setAngle(state, theta_0);
  plate.setRate(state, theta_rate);
  const Rotation plane = Rotation(phi_0, YAxis) * Rotation(theta_0, XAxis);
  const Vec3 omega(theta_rate, phi_rate * std::cos(theta_0), -phi_rate * std::sin(theta_0));
  const Vec3 centre(rig.position[0], rig.position[1], r);
  const Vec3 velocity = Vec3(rig.velocity[0], rig.velocity[1], 0) + omega % centre;
  const Vec3 turning = omega + Vec3(-rig.velocity[1] / r, rig.velocity[0] / r, rig.spin);
  sphere.setQToFitTransform(state, Transform(plane * centre));
  sphere.setUToFitAngularVelocity(state, plane * turning);
  sphere.setUToFitLinearVelocity(state, plane * velocity);

  RungeKuttaMersonIntegrator integrator(system);
  integrator.setAccuracy(1e-12);
  integrator.setConstraintTolerance(1e-12);
  TimeStepper stepper(system, integrator);
  stepper.initialize(state);

  std::vector<std::array<double, 2>> path;
  for (const double time : times) {
    stepper.stepTo(time);
    const State& now = stepper.getState();
    system.realize(now, Stage::Position);
    const Vec3 in_plane = ~plate.getBodyRotation(now) * sphere.getBodyOriginLocation(now);
    path.push_back({in_plane[0], in_plane[1]});
  }
  return path;
}

}  // namespace crosscheck
