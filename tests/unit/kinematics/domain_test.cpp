/** @file NaN and infinity in any field are refused by name, and whatever comes in, nothing but numbers comes
 * out. */
#include "kinematics/domain.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "random_joints.hpp"
#include "robots.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;
using Eigen::Vector3d;

const std::vector<double> not_numbers{std::numeric_limits<double>::quiet_NaN(),
                                      std::numeric_limits<double>::infinity(),
                                      -std::numeric_limits<double>::infinity()};

const NeuroJoints neuro_example{-20, 10, -15, 12, 0.3, 0.2, -0.7};
const ProstateJoints prostate_example{140, -120, 150, -130, 80, 0};

TEST(NotFinite, any_neuro_joint_is_refused_by_name) {
  for (const auto& field : neuro_joint_fields) {
    for (const double bad : not_numbers) {
      NeuroJoints joints = neuro_example;
      joints.*field.position = bad;
      const auto refused = neuro().zframe_from_treatment(joints);
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().code, Code::not_finite);
      EXPECT_EQ(refused.error().quantity, field.quantity);
      EXPECT_EQ(refused.error().value, std::nullopt);
      EXPECT_FALSE(neuro().zframe_from_entry(joints));
      EXPECT_FALSE(neuro().zframe_from_rcm(joints));
      EXPECT_FALSE(neuro().jacobian(joints));
    }
  }
}

TEST(NotFinite, any_prostate_joint_is_refused_by_name) {
  for (const auto& field : prostate_joint_fields) {
    for (const double bad : not_numbers) {
      ProstateJoints joints = prostate_example;
      joints.*field.position = bad;
      const auto refused = prostate().base_from_tip(joints);
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().code, Code::not_finite);
      EXPECT_EQ(refused.error().quantity, field.quantity);
      EXPECT_FALSE(prostate().base_from_needle_guide(joints));
      EXPECT_FALSE(prostate().jacobian(joints));
    }
  }
}

TEST(NotFinite, any_coordinate_of_entry_or_target_is_refused) {
  const Vector3d entry(8, 250, 70);
  const Vector3d target(5, 200, 60);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double bad : not_numbers) {
      Vector3d wrong_entry = entry;
      wrong_entry[axis] = bad;
      Vector3d wrong_target = target;
      wrong_target[axis] = bad;
      EXPECT_EQ(neuro().joints_for(wrong_entry, target).error().code, Code::not_finite);
      EXPECT_EQ(neuro().joints_for(entry, wrong_target).error().code, Code::not_finite);
      EXPECT_EQ(prostate().joints_for(wrong_entry, target).error().code, Code::not_finite);
      EXPECT_EQ(prostate().joints_for(entry, wrong_target).error().code, Code::not_finite);
      EXPECT_EQ(prostate().joints_for(wrong_target).error().code, Code::not_finite);
    }
  }
}

TEST(NotFinite, any_entry_of_a_pose_is_refused) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      for (const double bad : not_numbers) {
        Pose pose = *neuro().zframe_from_treatment(neuro_example);
        pose(row, column) = bad;
        EXPECT_EQ(neuro().joints_at_insertion(pose, 12.0).error().code, Code::not_finite);
        EXPECT_EQ(neuro().joints_for(pose, {8, 250, 70}).error().code, Code::not_finite);
        EXPECT_EQ(prostate().joints_for(pose).error().code, Code::not_finite);
      }
    }
  }
}

TEST(NotFinite, scalar_arguments_are_refused) {
  const Pose pose = *neuro().zframe_from_treatment(neuro_example);
  for (const double bad : not_numbers) {
    EXPECT_EQ(neuro().joints_at_insertion(pose, bad).error().quantity, "insertion_mm");
    EXPECT_EQ(neuro().joints_for({8, 250, 70}, {5, 200, 60}, bad).error().quantity, "probe_rotation_rad");
    EXPECT_EQ(prostate().joints_for(Vector3d(5, 150, 400), bad).error().quantity, "rotation_rad");
  }
}

TEST(Joints, limits_hold_from_both_sides) {
  for (const auto& field : neuro_joint_fields) {
    for (const double sign : {-1.0, 1.0}) {
      NeuroJoints joints;
      joints.*field.position = sign * field.limit;
      EXPECT_TRUE(check_joints(neuro_joint_fields, joints)) << field.quantity;
      joints.*field.position = sign * std::nextafter(field.limit, 1e9);
      EXPECT_EQ(check_joints(neuro_joint_fields, joints).error().quantity, field.quantity);
    }
  }
  for (const auto& field : prostate_joint_fields) {
    ProstateJoints joints;
    joints.*field.position = std::nextafter(field.limit, 1e9);
    EXPECT_EQ(check_joints(prostate_joint_fields, joints).error().code, Code::out_of_range);
  }
}

/** Ordinary, huge, tiny, zero and no numbers at all. */
double nasty(std::mt19937_64& generator) {
  switch (generator() % 8) {
    case 0:
      return std::numeric_limits<double>::quiet_NaN();
    case 1:
      return generator() % 2 == 0 ? std::numeric_limits<double>::infinity() : -1e308;
    case 2:
      return 1e-310;
    case 3:
      return 0.0;
    case 4:
      return std::uniform_real_distribution<double>(-1e4, 1e4)(generator);
    default:
      return std::uniform_real_distribution<double>(-300.0, 300.0)(generator);
  }
}

/** Answered results of hostile input are finite. */
template <typename Result>
void expect_numbers(const Result& result, const auto& is_finite) {
  if (result) {
    EXPECT_TRUE(is_finite(*result));
  } else {
    EXPECT_TRUE(!result.error().value || std::isfinite(*result.error().value)) << result.error().message();
    EXPECT_TRUE(std::isfinite(result.error().lowest) && std::isfinite(result.error().highest));
  }
}

TEST(NotFinite, nothing_but_numbers_leaves_whatever_comes_in) {
  const auto finite_pose = [](const Pose& pose) { return pose.matrix().allFinite(); };
  const auto finite_joints = [](const auto& fields) {
    return [&fields](const auto& joints) {
      return std::ranges::all_of(fields,
                                 [&](const auto& field) { return std::isfinite(joints.*field.position); });
    };
  };
  const NeuroKinematics neuro_kinematics = neuro();
  const ProstateKinematics prostate_kinematics = prostate();
  std::mt19937_64 generator(7);
  for (int trip = 0; trip < 50'000; ++trip) {
    NeuroJoints neuro_joints;
    for (const auto& field : neuro_joint_fields) {
      neuro_joints.*field.position = nasty(generator);
    }
    ProstateJoints prostate_joints;
    for (const auto& field : prostate_joint_fields) {
      prostate_joints.*field.position = nasty(generator);
    }
    const Vector3d entry(nasty(generator), nasty(generator), nasty(generator));
    const Vector3d target(nasty(generator), nasty(generator), nasty(generator));
    Pose pose = random_pose(generator, 300.0);
    if (trip % 2 == 0) {
      pose(static_cast<int>(generator() % 3), static_cast<int>(generator() % 4)) = nasty(generator);
    }
    expect_numbers(neuro_kinematics.zframe_from_treatment(neuro_joints), finite_pose);
    expect_numbers(neuro_kinematics.joints_for(entry, target), finite_joints(neuro_joint_fields));
    expect_numbers(neuro_kinematics.joints_for(pose, entry), finite_joints(neuro_joint_fields));
    expect_numbers(neuro_kinematics.joints_at_insertion(pose, nasty(generator)),
                   finite_joints(neuro_joint_fields));
    expect_numbers(prostate_kinematics.base_from_tip(prostate_joints), finite_pose);
    expect_numbers(prostate_kinematics.joints_for(pose), finite_joints(prostate_joint_fields));
    expect_numbers(prostate_kinematics.joints_for(entry, target), finite_joints(prostate_joint_fields));
    expect_numbers(prostate_kinematics.joints_for(target), finite_joints(prostate_joint_fields));
  }
}

TEST(Message, names_quantity_value_allowed_range_and_what_to_do) {
  const KinematicsError error{Code::separation, "separation_mm", 151.0, 75.0, 146.0};
  EXPECT_EQ(error.message(),
            "separation_mm of 151 is outside of the window of the trapezoid; allowed 75 to 146; "
            "choose other slider positions or another target");
  EXPECT_EQ(code_name(error.code), "SEPARATION");
  const KinematicsError nan{Code::not_finite, "pitch_rad", {}, -1.5, 1.5};
  EXPECT_EQ(nan.message(), "pitch_rad is not a finite number; allowed -1.5 to 1.5; give a number");
}

}  // namespace
}  // namespace interlock::test
