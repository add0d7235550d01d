/** @file The Jacobians agree with central differences of forward kinematics. */
#include <gmock/gmock.h>

#include <cmath>

#include "kinematics/manipulability.hpp"
#include "random_joints.hpp"
#include "robots.hpp"

namespace interlock::test {
namespace {

constexpr double step = 1e-5;
/** Central differences of positions near 300 mm: rounding 300 * 2e-16 / 1e-5, truncation below it. */
constexpr double difference_error = 1e-7;

/** Linear and angular velocity between two poses that a joint's small motion joins. */
Eigen::Matrix<double, 6, 1> velocity(const Pose& before, const Pose& after, double motion) {
  const Eigen::Matrix3d turn = after.linear() * before.linear().transpose();
  Eigen::Matrix<double, 6, 1> velocity;
  velocity << after.translation() - before.translation(),
      Eigen::Vector3d(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)) / 2.0;
  return velocity / motion;
}

template <typename Fields, typename Joints, typename Forward, typename Jacobian>
double worst_column(const Fields& fields, const Joints& joints, const Forward& forward,
                    const Jacobian& jacobian) {
  double worst = 0.0;
  for (std::size_t column = 0; column < fields.size(); ++column) {
    Joints before = joints;
    Joints after = joints;
    before.*fields[column].position -= step;
    after.*fields[column].position += step;
    const auto expected = velocity(forward(before), forward(after), 2.0 * step);
    worst =
        std::max(worst, (jacobian.col(static_cast<Eigen::Index>(column)) - expected).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(NeuroJacobian, agrees_with_central_differences) {
  const NeuroKinematics kinematics = neuro();
  const auto forward = [&](const NeuroJoints& joints) { return *kinematics.zframe_from_treatment(joints); };
  std::mt19937_64 generator(1);
  double worst = 0.0;
  for (int trip = 0; trip < 1000; ++trip) {
    NeuroJoints joints = random_neuro_joints(generator);
    joints.head_mm = 0.999 * joints.head_mm + 0.001 * (joints.feet_mm - 30.0);  // room for the step
    worst = std::max(worst, worst_column(neuro_joint_fields, joints, forward, *kinematics.jacobian(joints)));
  }
  std::printf("neuro Jacobian: worst difference %.3g\n", worst);
  EXPECT_LE(worst, difference_error);
}

TEST(ProstateJacobian, agrees_with_central_differences) {
  ProstateTrapezoids geometry = prostate_geometry();
  geometry.needle_height_mm = 7.0;
  ProstateTrapezoids roomy = geometry;
  roomy.max_separation_mm += 0.001;
  roomy.max_angulation_rad += 0.001;
  const ProstateKinematics strict = ProstateKinematics::create(geometry).value();
  const ProstateKinematics kinematics = ProstateKinematics::create(roomy).value();
  const auto forward = [&](const ProstateJoints& joints) { return *kinematics.base_from_tip(joints); };
  std::mt19937_64 generator(2);
  double worst = 0.0;
  int checked = 0;
  while (checked < 1000) {
    const ProstateJoints joints = random_prostate_joints(generator);
    if (strict.base_from_tip(joints)) {
      worst =
          std::max(worst, worst_column(prostate_joint_fields, joints, forward, *kinematics.jacobian(joints)));
      ++checked;
    }
  }
  std::printf("prostate Jacobian: worst difference %.3g\n", worst);
  EXPECT_LE(worst, difference_error);
}

TEST(Manipulability, is_the_product_of_the_singular_values) {
  const NeuroJoints joints{-20, 10, -15, 12, 0.3, 0.2, -0.7};
  const auto jacobian = *neuro().jacobian(joints);
  const auto result = manipulability(jacobian, neuro_joint_fields, 1.0);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->measure, std::sqrt((jacobian * jacobian.transpose()).determinant()), 1e-9);
  EXPECT_GT(result->smallest, 0.0);
  EXPECT_GE(result->largest, result->smallest);
}

TEST(Manipulability, counts_a_radian_as_the_characteristic_length) {
  const ProstateJoints joints{140, -120, 150, -130, 80, 0};
  const auto jacobian = *prostate().jacobian(joints);
  const double unit_length = manipulability(jacobian, prostate_joint_fields, 1.0)->measure;
  const double longer = manipulability(jacobian, prostate_joint_fields, 100.0)->measure;
  EXPECT_NEAR(longer / unit_length, 100.0 * 100.0, 1e-4) << "three angular rows, one angular joint";
}

TEST(Manipulability, vanishes_where_the_yaw_axis_meets_the_probe_axis) {
  const auto at_pitch = [](double pitch_rad) {
    return manipulability(*neuro().jacobian({.head_mm = -20.0, .pitch_rad = pitch_rad}), neuro_joint_fields,
                          100.0)
        ->smallest;
  };
  EXPECT_GT(at_pitch(0.6), 0.01);
  EXPECT_NEAR(at_pitch(std::numbers::pi / 2), 0.0, 1e-12);
}

TEST(Manipulability, characteristic_length_without_sense_is_refused) {
  const auto jacobian = *neuro().jacobian(NeuroJoints{});
  for (const double bad : {0.0, -1.0, 1e5, std::nan("")}) {
    EXPECT_EQ(manipulability(jacobian, neuro_joint_fields, bad).error().quantity, "characteristic_length_mm");
  }
}

}  // namespace
}  // namespace interlock::test
