#include "model/dynamics.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "model/rolling.hpp"

namespace bbsim::model {

using Eigen::Vector3d;

BallConstants constants_of(const Scenario& scene) {
  BallConstants constants{scene.ball.radius, scene.ball.mass, scene.gravity};
  constants.papers_rig = is_the_papers(scene);
  constants.rolling = general_rolling(scene);
  if (scene.plate.inertia) constants.plate_inertia = *scene.plate.inertia;
  return constants;
}

Dynamics dynamics(const Sample& sample, const BallConstants& constants) {
  const double r = constants.radius, m = constants.mass, g = constants.gravity;
  const GeneralRolling& rolling = constants.rolling;
  const GimbalMotion& gimbal = sample.gimbal;
  const BallMotion& ball = sample.ball;

  const auto [sin_phi, cos_phi] = sin_cos(gimbal.phi);
  const auto [s, c] = sin_cos(gimbal.theta);
  const Axis<double> phi{sin_phi, cos_phi, gimbal.phi_dot, gimbal.phi_ddot};
  const Axis<double> theta{s, c, gimbal.theta_dot, gimbal.theta_ddot};
  const RollingState<double, double, double> state{ball.x, ball.y, ball.x_dot, ball.y_dot,
                                                   r * ball.gamma_dot};

  // All vectors in the plane frame.
  const auto plane = rolling.kinematics(phi, theta);
  const Vector3d theta_axis(plane.theta_axis[0], plane.theta_axis[1], 0);
  const Vector3d phi_axis(plane.phi_axis), phi_axis_slope(plane.phi_axis_slope), up(plane.up);
  const Vector3d omega = theta_axis * theta.rate + phi_axis * phi.rate;
  const Vector3d omega_dot = theta_axis * theta.acceleration + phi_axis * phi.acceleration +
                             phi_axis_slope * (phi.rate * theta.rate);
  const Vector3d contact(ball.x, ball.y, rolling.height);
  const Vector3d centre(ball.x, ball.y, rolling.height + r);
  const Vector3d velocity(ball.x_dot, ball.y_dot, 0);
  const auto relative = [&](const Axis<double>& p, const Axis<double>& t) {
    if (constants.papers_rig) {
      return Vector3d(x_acceleration<double>(p, t, state, r, g),
                      y_acceleration<double>(p, t, state, r, g), 0);
    }
    const auto rates = rolling.rates<double>(p, t, state, r, g);
    return Vector3d(rates.x, rates.y, 0);
  };

  const Vector3d centre_acceleration = relative(phi, theta) + 2 * omega.cross(velocity) +
                                       omega_dot.cross(centre) + omega.cross(omega.cross(centre));
  const Vector3d centre_velocity = velocity + omega.cross(centre);
  const Vector3d ball_omega = omega + Vector3d(-ball.y_dot / r, ball.x_dot / r, ball.gamma_dot);

  Dynamics result;
  result.force = m * (centre_acceleration + g * up);
  const Vector3d moment = contact.cross(result.force);
  result.torque_phi = phi_axis.dot(moment);
  result.torque_theta = theta_axis.dot(moment);
  result.energy = m * centre_velocity.squaredNorm() / 2 +
                  rolling.k / 2 * m * r * r * ball_omega.squaredNorm() + m * g * centre.dot(up);

  const Vector3d inertia(constants.plate_inertia.data());
  const Vector3d plate_moment =
      inertia.cwiseProduct(omega_dot) + omega.cross(inertia.cwiseProduct(omega));
  result.plate_torque_phi = phi_axis.dot(plate_moment);
  result.plate_torque_theta = theta_axis.dot(plate_moment);

  result.tilt = std::atan2(std::hypot(up.x(), up.y()), up.z());
  result.tilt_rate = omega.norm();
  const Axis<double> still_phi{sin_phi, cos_phi, 0, 0}, still_theta{s, c, 0, 0};
  const Vector3d rest = relative(still_phi, still_theta);
  const Vector3d by_phi = relative({sin_phi, cos_phi, 0, 1}, still_theta) - rest;
  const Vector3d by_theta = relative(still_phi, {s, c, 0, 1}) - rest;
  result.singularity_distance =
      std::abs(by_phi.x() * by_theta.y() - by_theta.x() * by_phi.y()) / (r * r);
  return result;
}

}  // namespace bbsim::model
