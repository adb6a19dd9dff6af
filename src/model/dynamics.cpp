#include "model/dynamics.hpp"

#include <Eigen/Geometry>

#include "model/rolling.hpp"

namespace bbsim::model {

using Eigen::Vector3d;

Dynamics dynamics(const Sample& sample, const BallConstants& constants) {
  const auto [r, m, g] = constants;
  const GimbalMotion& gimbal = sample.gimbal;
  const BallMotion& ball = sample.ball;

  const auto [sin_phi, cos_phi] = sin_cos(gimbal.phi);
  const auto [s, c] = sin_cos(gimbal.theta);
  const Axis<double> phi{sin_phi, cos_phi, gimbal.phi_dot, gimbal.phi_ddot};
  const Axis<double> theta{s, c, gimbal.theta_dot, gimbal.theta_ddot};
  const RollingState<double, double, double> rolling{ball.x, ball.y, ball.x_dot, ball.y_dot,
                                                     r * ball.gamma_dot};

  // All vectors in the plane frame.
  const Vector3d omega(theta.rate, phi.rate * c, -phi.rate * s);
  const Vector3d omega_dot(theta.acceleration, phi.acceleration * c - phi.rate * theta.rate * s,
                           -phi.acceleration * s - phi.rate * theta.rate * c);
  const Vector3d up(-sin_phi, cos_phi * s, cos_phi * c);
  const Vector3d contact(ball.x, ball.y, 0);
  const Vector3d centre(ball.x, ball.y, r);
  const Vector3d velocity(ball.x_dot, ball.y_dot, 0);
  const Vector3d relative_acceleration(x_acceleration<double>(phi, theta, rolling, r, g),
                                       y_acceleration<double>(phi, theta, rolling, r, g), 0);

  const Vector3d centre_acceleration = relative_acceleration + 2 * omega.cross(velocity) +
                                       omega_dot.cross(centre) + omega.cross(omega.cross(centre));
  const Vector3d centre_velocity = velocity + omega.cross(centre);
  const Vector3d ball_omega = omega + Vector3d(-ball.y_dot / r, ball.x_dot / r, ball.gamma_dot);

  Dynamics result;
  result.force = m * (centre_acceleration + g * up);
  const Vector3d moment = contact.cross(result.force);
  result.torque_phi = Vector3d(0, c, -s).dot(moment);
  result.torque_theta = moment.x();
  result.energy = m * centre_velocity.squaredNorm() / 2 + m * r * r * ball_omega.squaredNorm() / 5 +
                  m * g * centre.dot(up);
  return result;
}

}  // namespace bbsim::model
