#include "targeting/error_budget.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "kinematics/domain.hpp"

namespace interlock {
namespace {

using Code = KinematicsError::Code;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/** Chi-square of three degrees of freedom below which 95 % of a Gaussian lies. */
constexpr double chi_square_95 = 7.814727903251179;
/** Root mean square distance of the fiducials from the line that they are nearest to. */
constexpr double least_spread_mm = 1.0;
/** Standard deviation of a turn of the registration, beyond which its second order does not describe it. */
constexpr double largest_turn_rad = 0.25;
constexpr double fewest_fiducials = 3.0;
constexpr double most_fiducials = 1e6;

/** What contributes to the error of one point, in the order of the budget. */
using Covariances = std::array<Matrix3d, std::tuple_size_v<decltype(ErrorBudget::contributions)>>;

double squared(double value) { return value * value; }

double encoder_counts2(const Axis& axis, double /*position*/) {
  return squared(axis.deadband_counts + 0.5) / 3.0;
}

double play_counts2(const Axis& axis, double position) {
  const double play = axis.mechanics.tool_play_counts.value_or(0);
  const auto counts = axis.to_counts(position);
  const bool taken_up = counts && axis.take_up_counts(*counts);
  // From above the tool is as far off as it can be, each time: no chance makes it less.
  return taken_up ? squared(std::min(play, axis.deadband_counts + 0.5)) / 3.0 : squared(play);
}

/** Of a point that moves with the axes at these positions by the columns of `motion`. */
Matrix3d covariance_of(const Robot& robot, const AxisPositions& positions, const Eigen::Matrix3Xd& motion,
                       double (*counts2)(const Axis&, double)) {
  Matrix3d sum = Matrix3d::Zero();
  for (std::size_t place = 0; place < robot.axes.size(); ++place) {
    const Axis& axis = robot.axes[place];
    const Vector3d by_count = motion.col(static_cast<Eigen::Index>(place)) / axis.counts_per_unit;
    sum += counts2(axis, positions[place]) * by_count * by_count.transpose();
  }
  return sum;
}

bool has_measured_play(const Axis& axis) { return axis.mechanics.tool_play_counts.has_value(); }

Matrix3d cross_with(const Vector3d& lever) {
  return (Matrix3d() << 0.0, -lever.z(), lever.y(), lever.z(), 0.0, -lever.x(), -lever.y(), lever.x(), 0.0)
      .finished();
}

/** By how much more a covariance has to count that was estimated from the residual of so many fiducials. */
double widening(double fiducials) {
  const boost::math::fisher_f estimated(3.0, 3.0 * fiducials - 6.0);
  return 3.0 * boost::math::quantile(estimated, 0.95) / chi_square_95;
}

/** The bend is r z² w/2 of a turn by z deviations, which is far along the way across, too: with 2 r² w² in
 * place of its mean square, 3/4 r² w², 95 % of the points lie within both. */
constexpr double bend = 2.0;

/** What a registration does to any point of the scanner. */
struct RegistrationError {
  Vector3d centroid_mm = Vector3d::Zero();
  double shift_mm2 = 0.0;
  Matrix3d axes = Matrix3d::Identity(); /**< about which it turns: unit vectors, columns */
  Vector3d turn_rad2 = Vector3d::Zero();

  [[nodiscard]] Matrix3d at(const Vector3d& point) const {
    Matrix3d sum = shift_mm2 * Matrix3d::Identity();
    for (Eigen::Index place = 0; place < 3; ++place) {
      const Vector3d axis = axes.col(place);
      const Vector3d along = axis.cross(point - centroid_mm);
      const Vector3d inwards = axis.cross(along);
      sum += turn_rad2[place] * along * along.transpose() +
             bend * squared(turn_rad2[place]) * inwards * inwards.transpose();
    }
    return sum;
  }
};

KinematicsResult<RegistrationError> registration_error(const RegistrationFit& fit) {
  const auto count = static_cast<double>(fit.fiducials_mm.size());
  return check_range("fiducials", count, fewest_fiducials, most_fiducials).and_then([&] {
    RegistrationError error;
    for (const Vector3d& each : fit.fiducials_mm) {
      error.centroid_mm += each / count;
    }
    Matrix3d scatter = Matrix3d::Zero();
    for (const Vector3d& each : fit.fiducials_mm) {
      scatter += (each - error.centroid_mm) * (each - error.centroid_mm).transpose() / count;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(scatter);
    const Vector3d from_axis_mm2 =
        Vector3d::Constant(scatter.trace()) - principal.eigenvalues().cwiseMax(0.0);
    return check_range("fiducial_spread_mm", std::sqrt(std::max(0.0, from_axis_mm2.minCoeff())),
                       least_spread_mm, length_limit_mm, Code::singular)
        .and_then([&] {
          error.shift_mm2 = widening(count) * squared(fit.residual_mm) / (3.0 * (count - 2.0));
          error.axes = principal.eigenvectors();
          error.turn_rad2 = error.shift_mm2 * from_axis_mm2.cwiseInverse();
          return check_range("registration_turn_rad", std::sqrt(error.turn_rad2.maxCoeff()), 0.0,
                             largest_turn_rad, Code::singular);
        })
        .map([&] { return error; });
  });
}

ErrorEllipsoid ellipsoid_of(const Vector3d& centre, const Covariances& covariances) {
  ErrorEllipsoid ellipsoid;
  ellipsoid.centre_mm = centre;
  for (const Matrix3d& each : covariances) {
    ellipsoid.covariance_mm2 += each;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(ellipsoid.covariance_mm2);
  ellipsoid.half_axes_mm = (chi_square_95 * principal.eigenvalues().cwiseMax(0.0)).cwiseSqrt().reverse();
  ellipsoid.directions = principal.eigenvectors().rowwise().reverse();
  return ellipsoid;
}

/** Half the width along the ellipsoid's longest half axis. */
double width_mm(const ErrorEllipsoid& ellipsoid, const Matrix3d& covariance) {
  const Vector3d along = ellipsoid.directions.col(0);
  return std::sqrt(std::max(0.0, chi_square_95 * along.dot(covariance * along)));
}

}  // namespace

KinematicsResult<ErrorBudget> error_budget_of(const Robot& robot, const RobotKinematics& kinematics,
                                              const Pose& scanner_from_zframe, const AxisPositions& positions,
                                              const ImageAccuracy& accuracy) {
  const auto pose = kinematics.zframe_from_treatment(positions);
  const auto jacobian = pose.and_then([&](const Pose&) { return kinematics.jacobian(positions); });
  const auto registration = jacobian.and_then([&](const Jacobian&) {
    return accuracy.registration ? registration_error(*accuracy.registration)
                                 : KinematicsResult<RegistrationError>();
  });
  return registration.map([&](const RegistrationError& registered) {
    const auto at = [&](double beyond_mm, Covariances& covariances) {
      const Vector3d lever = beyond_mm * pose->linear().col(2);
      const Eigen::Matrix3Xd motion =
          scanner_from_zframe.linear() *
          (jacobian->topRows<3>() - cross_with(lever) * jacobian->bottomRows<3>());
      const Vector3d point = scanner_from_zframe * (pose->translation() + lever);
      covariances = {registered.at(point), covariance_of(robot, positions, motion, encoder_counts2),
                     covariance_of(robot, positions, motion, play_counts2),
                     squared(robot.calibration_mm.value_or(0.0)) * Matrix3d::Identity(),
                     accuracy.target_mm2.value_or(Matrix3d::Zero())};
      return ellipsoid_of(point, covariances);
    };
    Covariances of_treatment;
    Covariances of_tip;
    ErrorBudget budget;
    budget.treatment = at(0.0, of_treatment);
    budget.tip = at(kinematics.probe().treatment_to_tip_mm, of_tip);
    constexpr std::string_view stated;
    budget.contributions = {{
        {"registration", 0.0, 0.0,
         accuracy.registration
             ? stated
             : "The registration came without its residual and the points of its fiducials, "
               "or its rotation is ignored."},
        {"encoder", 0.0, 0.0, stated},
        {"play", 0.0, 0.0,
         std::ranges::all_of(robot.axes, has_measured_play)
             ? stated
             : "The robot's file does not have mechanics.tool_play_counts for every axis."},
        {"calibration", 0.0, 0.0, robot.calibration_mm ? stated : "The robot's file has no calibration_mm."},
        {"image", 0.0, 0.0, accuracy.target_mm2 ? stated : "The target came without a covariance."},
    }};
    for (std::size_t place = 0; place < budget.contributions.size(); ++place) {
      budget.contributions[place].treatment_mm = width_mm(budget.treatment, of_treatment[place]);
      budget.contributions[place].tip_mm = width_mm(budget.tip, of_tip[place]);
    }
    return budget;
  });
}

}  // namespace interlock
