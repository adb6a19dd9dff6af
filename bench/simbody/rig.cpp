// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "rig.hpp"

#include <Simbody.h>

#include <cmath>
#include <optional>

namespace crosscheck {
namespace {

using namespace SimTK;

// A gimbal angle and its derivatives as a Simbody function of time.
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

// Torques of the motors on the gimbal's two pins, minus the viscous torques of the bearings.
class Torques : public Force::Custom::Implementation {
 public:
  Torques(const Driven& driven, const MobilizedBody::Pin& phi, const MobilizedBody::Pin& theta)
      : driven_(driven), pins_{&phi, &theta} {}

  void calcForce(const State& state, Vector_<SpatialVec>&, Vector_<Vec3>&,
                 Vector& mobility_forces) const override {
    for (int i = 0; i < 2; ++i) {
      const double rate = pins_[i]->getRate(state);
      pins_[i]->applyOneMobilityForce(
          state, 0, driven_.torque(state.getTime(), i) - driven_.viscous * rate, mobility_forces);
    }
  }
  Real calcPotentialEnergy(const State&) const override { return 0; }

 private:
  const Driven& driven_;
  const MobilizedBody::Pin* pins_[2];
};

Body::Rigid ring_of(const Rig& rig) {
  // The ring turns about one axis only, and the rotor of phi's motor turns with it.
  const double about = rig.driven ? rig.driven->ring_inertia + rig.driven->rotor_inertia : 1;
  return Body::Rigid(MassProperties(1, Vec3(0), Inertia(about)));
}

// The inertia is about the gimbal's fixed center. The mass has no effect there; the weight is a
// separate force.
Body::Rigid plate_of(const Rig& rig) {
  if (!rig.driven) return Body::Rigid(MassProperties(1, Vec3(0), Inertia(1)));
  const auto& [x, y, z] = rig.driven->plate_inertia;
  return Body::Rigid(MassProperties(1, Vec3(0), Inertia(x, y, z)));
}

}  // namespace

std::vector<std::array<double, 4>> simulate(const Rig& rig, const std::vector<double>& times) {
  MultibodySystem system;
  SimbodyMatterSubsystem matter(system);
  GeneralForceSubsystem forces(system);
  Force::Gravity gravity(forces, matter, Vec3(0, 0, -rig.gravity));

  // A pin turns about the z axis of its frames. These rotations turn that axis to y and to x.
  const Transform about_y(Rotation(-Pi / 2, XAxis)), about_x(Rotation(Pi / 2, YAxis));
  MobilizedBody::Pin outer(matter.Ground(), about_y, ring_of(rig), about_y);
  MobilizedBody::Pin plate(outer, about_x, plate_of(rig), about_x);
  const double r = rig.radius, m = rig.mass;
  const Body::Rigid ball(MassProperties(m, Vec3(0), Inertia(0.4 * m * r * r)));
  MobilizedBody::Free sphere(matter.Ground(), Transform(), ball, Transform());
  std::optional<MobilizedBody::Pin> rotor;
  if (rig.driven) {
    Force::Custom(forces, new Torques(*rig.driven, outer, plate));
    Force::ConstantForce(forces, plate, Vec3(0, 0, rig.driven->centre_of_mass),
                         Vec3(0, 0, -rig.driven->plate_mass * rig.gravity));
    // The rotor of theta's motor turns with the plate in the ring, but about a fixed axis.
    const double inertia = rig.driven->rotor_inertia;
    if (inertia > 0) {
      rotor.emplace(matter.Ground(), about_x,
                    Body::Rigid(MassProperties(1, Vec3(0), Inertia(inertia))), about_x);
      Array_<MobilizedBodyIndex> bodies;
      bodies.push_back(plate.getMobilizedBodyIndex());
      bodies.push_back(rotor->getMobilizedBodyIndex());
      Array_<MobilizerQIndex> coordinates(2, MobilizerQIndex(0));
      Vector factors(3, 0.0);
      factors[0] = 1;
      factors[1] = -1;
      Constraint::CoordinateCoupler(matter, new Function::Linear(factors), bodies, coordinates);
    }
  } else {
    Constraint::PrescribedMotion(matter, new Angle(rig, 0), outer, MobilizerQIndex(0));
    Constraint::PrescribedMotion(matter, new Angle(rig, 1), plate, MobilizerQIndex(0));
  }
  Constraint::SphereOnPlaneContact rolling(plate, Transform(), sphere, Vec3(0), r, true);

  State state = system.realizeTopology();
  const auto start = [&](int axis, int order) {
    if (!rig.driven) return rig.angle(0, axis, order);
    return (order == 0 ? rig.driven->angles : rig.driven->rates)[static_cast<std::size_t>(axis)];
  };
  const double phi_0 = start(0, 0), phi_rate = start(0, 1);
  const double theta_0 = start(1, 0), theta_rate = start(1, 1);
  outer.setAngle(state, phi_0);
  outer.setRate(state, phi_rate);
  plate.setAngle(state, theta_0);
  plate.setRate(state, theta_rate);
  if (rotor) {
    rotor->setAngle(state, theta_0);
    rotor->setRate(state, theta_rate);
  }
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

  std::vector<std::array<double, 4>> path;
  for (const double time : times) {
    stepper.stepTo(time);
    const State& now = stepper.getState();
    system.realize(now, Stage::Position);
    const Vec3 in_plane = ~plate.getBodyRotation(now) * sphere.getBodyOriginLocation(now);
    path.push_back({in_plane[0], in_plane[1], outer.getAngle(now), plate.getAngle(now)});
  }
  return path;
}

}  // namespace crosscheck
