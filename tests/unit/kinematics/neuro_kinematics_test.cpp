/** @file The NeuroRobot's kinematics give the reference values, invert exactly and refuse what is outside. */
#include "kinematics/neuro_rcm/neuro_kinematics.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "expectations.hpp"
#include "random_joints.hpp"
#include "robots.hpp"

namespace interlock::test {
namespace {

using Code = KinematicsError::Code;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const Matrix3d home_rotation = (Matrix3d() << -1, 0, 0, 0, 0, -1, 0, -1, 0).finished();

struct ForwardCase {
  NeuroJoints joints;
  Vector3d rcm;
  Vector3d treatment;
};

const std::vector<ForwardCase> forward_cases{
    {{0, 0, 0, 0, 0, 0, 0}, {18.32, 178.39, 72.91}, {18.32, 209.89, 72.91}},
    {{-20, 10, -15, 12, 0.3, 0.2, -0.7}, {3.32, 201.530192, 67.91}, {7.194052, 216.147319, 80.221836}},
    {{-68, 0, -49.47, 34.9, 0, -0.46, -1.5},
     {-31.15, 213.818668, 38.91},
     {-29.640576, 213.603162, 35.871053}},
};

struct InverseCase {
  Vector3d entry;
  Vector3d target;
  NeuroJoints joints;
};

const std::vector<InverseCase> inverse_cases{
    {{8, 250, 70}, {5, 200, 60}, {-18.420966, -13.829007, -14.284496, 15.078371, 0, 0.058767, -0.197396}},
    {{-5, 262, 55}, {0, 215, 45}, {-42.060069, -21.703594, -16.334084, 12.311489, 0, -0.103681, -0.209640}},
    {{10, 245, 60}, {10, 205, 60}, {-12.599780, -13.220220, -8.32, 4.0, 0, 0, 0}},
};

TEST(NeuroForward, gives_the_reference_positions) {
  for (const ForwardCase& reference : forward_cases) {
    expect_near(neuro().zframe_from_rcm(reference.joints)->translation(), reference.rcm, reference_digits);
    expect_near(neuro().zframe_from_treatment(reference.joints)->translation(), reference.treatment,
                reference_digits);
  }
}

TEST(NeuroForward, gives_the_reference_rotations) {
  EXPECT_TRUE(neuro().zframe_from_treatment(NeuroJoints{})->linear().isApprox(home_rotation, 1e-15));
  const Matrix3d reference = (Matrix3d() << -0.936293, 0.289629, -0.198669, 0.335543, 0.570540, -0.749596,
                              -0.103756, -0.768504, -0.631376)
                                 .finished();
  EXPECT_LE(
      (neuro().zframe_from_treatment(forward_cases[1].joints)->linear() - reference).cwiseAbs().maxCoeff(),
      reference_digits);
}

TEST(NeuroForward, points_along_minus_y_at_home_minus_z_at_yaw_90_and_minus_x_with_positive_pitch) {
  const auto advance = [](double pitch, double yaw) -> Vector3d {
    return neuro().zframe_from_treatment({.pitch_rad = pitch, .yaw_rad = yaw})->linear().col(2);
  };
  expect_near(advance(0, 0), -Vector3d::UnitY(), 1e-15);
  expect_near(advance(0, -90 * degree), -Vector3d::UnitZ(), 1e-15);
  EXPECT_LT(advance(0.1, 0).x(), 0.0);
}

TEST(NeuroForward, entry_lies_on_the_probe_and_does_not_follow_the_insertion) {
  NeuroJoints joints = forward_cases[1].joints;
  const Pose entry = *neuro().zframe_from_entry(joints);
  const Pose treatment = *neuro().zframe_from_treatment(joints);
  const double depth = joints.insertion_mm + 41.0 - 5.0;
  expect_near(treatment.translation(), entry.translation() + depth * entry.linear().col(2), 1e-12);
  joints.insertion_mm += 7.0;
  EXPECT_EQ(neuro().zframe_from_entry(joints)->translation(), entry.translation());
}

TEST(NeuroForward, later_calibrations_only_move_the_rcm) {
  NeuroRcm longer_links = neuro_geometry();
  longer_links.home_rcm_mm = {-32.41, 154.38, 84.198};
  const auto moved =
      NeuroKinematics::create(longer_links, neuro_probe())->zframe_from_treatment(NeuroJoints{});
  expect_near(moved->translation() - neuro().zframe_from_treatment(NeuroJoints{})->translation(),
              {-50.73, -24.01, 11.288}, 1e-12);
}

TEST(NeuroForward, rotation_is_proper_for_random_joints) {
  std::mt19937_64 generator(1);
  for (int trip = 0; trip < round_trips; ++trip) {
    const Matrix3d rotation = neuro().zframe_from_treatment(random_neuro_joints(generator))->linear();
    ASSERT_LE((rotation.transpose() * rotation - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
    ASSERT_NEAR(rotation.determinant(), 1.0, 1e-14);
  }
}

TEST(NeuroInverse, gives_the_reference_joints_from_entry_and_target) {
  for (const InverseCase& reference : inverse_cases) {
    const auto joints = neuro().joints_for(reference.entry, reference.target);
    ASSERT_TRUE(joints) << joints.error().message();
    EXPECT_LE(distance(*joints, reference.joints), reference_digits);
  }
}

TEST(NeuroInverse, keeps_the_separations_of_the_reference) {
  const std::vector<double> separations{138.408, 122.644, 143.620};
  for (std::size_t number = 0; number < separations.size(); ++number) {
    const auto joints = *neuro().joints_for(inverse_cases[number].entry, inverse_cases[number].target);
    EXPECT_NEAR(143.0 + joints.head_mm - joints.feet_mm, separations[number], 1e-3);
  }
}

TEST(NeuroInverse, meets_entry_and_target) {
  for (const InverseCase& reference : inverse_cases) {
    const auto joints = *neuro().joints_for(reference.entry, reference.target, 0.5);
    EXPECT_EQ(joints.probe_rotation_rad, 0.5);
    expect_near(neuro().zframe_from_treatment(joints)->translation(), reference.target, exact);
    expect_near(neuro().zframe_from_entry(joints)->translation(), reference.entry, exact);
  }
}

TEST(NeuroInverse, undoes_forward_from_pose_and_entry) {
  const NeuroKinematics kinematics = neuro();
  std::mt19937_64 generator(2);
  double worst_joints = 0.0;
  double worst_pose = 0.0;
  for (int trip = 0; trip < round_trips; ++trip) {
    const NeuroJoints joints = random_neuro_joints(generator);
    const Pose pose = *kinematics.zframe_from_treatment(joints);
    const auto found = kinematics.joints_for(pose, kinematics.zframe_from_entry(joints)->translation());
    ASSERT_TRUE(found) << found.error().message();
    worst_joints = std::max(worst_joints, distance(*found, joints));
    worst_pose = std::max(worst_pose, distance(*kinematics.zframe_from_treatment(*found), pose));
  }
  std::printf("neuro, pose and entry: worst joint error %.3g, worst pose error %.3g\n", worst_joints,
              worst_pose);
  EXPECT_LE(worst_joints, exact);
  EXPECT_LE(worst_pose, exact);
}

TEST(NeuroInverse, undoes_forward_from_entry_and_target) {
  const NeuroKinematics kinematics = neuro();
  std::mt19937_64 generator(3);
  double worst = 0.0;
  for (int trip = 0; trip < round_trips; ++trip) {
    const NeuroJoints joints = random_neuro_joints(generator);
    const auto found = kinematics.joints_for(kinematics.zframe_from_entry(joints)->translation(),
                                             kinematics.zframe_from_treatment(joints)->translation(),
                                             joints.probe_rotation_rad);
    ASSERT_TRUE(found) << found.error().message();
    worst = std::max(worst, distance(*found, joints));
  }
  std::printf("neuro, entry and target: worst joint error %.3g\n", worst);
  EXPECT_LE(worst, exact);
}

TEST(NeuroInverse, trades_insertion_against_the_base_when_only_a_pose_is_given) {
  const NeuroJoints joints = forward_cases[1].joints;
  const Pose pose = *neuro().zframe_from_treatment(joints);
  EXPECT_LE(distance(*neuro().joints_at_insertion(pose, joints.insertion_mm), joints), exact);
  const auto deeper = *neuro().joints_at_insertion(pose, joints.insertion_mm + 5.0);
  EXPECT_GT(distance(deeper, joints), 1.0);
  EXPECT_LE(distance(*neuro().zframe_from_treatment(deeper), pose), exact);
}

TEST(NeuroPublishedMistakes, pitch_is_not_distorted_by_the_yaw) {
  const NeuroJoints joints{-20, 10, -15, 12, 0, 0.40, -1.0};
  const Vector3d entry = neuro().zframe_from_entry(joints)->translation();
  const Vector3d target = neuro().zframe_from_treatment(joints)->translation();
  const Vector3d n = home_rotation * (target - entry).normalized();
  EXPECT_NEAR(std::atan(n.x() / n.z()), 0.664, 1e-3) << "what early copies compute";
  EXPECT_NEAR(neuro().joints_for(entry, target)->pitch_rad, 0.40, exact);
}

TEST(NeuroPublishedMistakes, separation_beyond_the_links_is_refused_where_others_answer_nan) {
  const auto refused = neuro().zframe_from_treatment({.head_mm = 8.0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), (KinematicsError{Code::separation, "separation_mm", 151.0, 75.0, 146.0}));
}

TEST(NeuroDomain, separation_window_holds_from_both_sides) {
  const double rounding = 0.5 * boundary_slack;
  const double outside = 2.0 * boundary_slack;
  EXPECT_TRUE(neuro().zframe_from_treatment({.head_mm = 3.0 + rounding}));
  EXPECT_TRUE(neuro().zframe_from_treatment({.head_mm = -68.0 - rounding}));
  EXPECT_EQ(neuro().zframe_from_treatment({.head_mm = 3.0 + outside}).error().code, Code::separation);
  EXPECT_EQ(neuro().zframe_from_treatment({.head_mm = -68.0 - outside}).error().code, Code::separation);
}

TEST(NeuroDomain, inverse_accepts_the_ends_of_the_window_and_refuses_beyond) {
  for (const double separation : {75.0, 146.0}) {
    const NeuroJoints end{.head_mm = separation - 143.0, .pitch_rad = 0.1, .yaw_rad = -0.3};
    const Pose pose = *neuro().zframe_from_treatment(end);
    const auto found = neuro().joints_at_insertion(pose, 0.0);
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_LE(distance(*found, end), exact);
    Pose beyond = pose;
    beyond.translation().y() += separation == 75.0 ? 1e-6 : -1e-6;
    EXPECT_EQ(neuro().joints_at_insertion(beyond, 0.0).error().code, Code::separation);
  }
}

TEST(NeuroDomain, height_beyond_the_links_is_out_of_reach) {
  const auto too_high = neuro().joints_for({10, 300, 60}, {10, 260, 60});
  EXPECT_EQ(too_high.error().code, Code::out_of_reach);
  EXPECT_EQ(too_high.error().quantity, "rise_mm");
  EXPECT_EQ(too_high.error().highest, 60.0);
  const auto too_low = neuro().joints_for({10, 150, 60}, {10, 110, 60});
  EXPECT_EQ(too_low.error().code, Code::out_of_reach);
  EXPECT_LT(too_low.error().value, 0.0);
}

TEST(NeuroDomain, entry_on_the_target_is_degenerate) {
  const Vector3d entry = inverse_cases[2].entry;
  EXPECT_EQ(neuro().joints_for(entry, entry).error(),
            (KinematicsError{Code::degenerate, "entry_to_target_mm", 0.0, shortest_path_mm,
                             4.0 * length_limit_mm}));
  EXPECT_EQ(neuro().joints_for(entry, entry - Vector3d(0, 0.99e-3, 0)).error().code, Code::degenerate);
  EXPECT_TRUE(neuro().joints_for(entry, entry - Vector3d(0, 1.01e-3, 0)));
}

TEST(NeuroDomain, approach_along_x_is_singular) {
  const Vector3d target(10, 205, 60);
  const auto from = [&](double cos_pitch) {
    const Vector3d approach(-std::sqrt(1.0 - cos_pitch * cos_pitch), -cos_pitch, 0.0);
    return neuro().joints_for(target - 40.0 * approach, target);
  };
  EXPECT_EQ(from(0.0).error().code, Code::singular);
  EXPECT_EQ(from(0.99 * smallest_cos_pitch).error().code, Code::singular);
  ASSERT_TRUE(from(1.01 * smallest_cos_pitch)) << from(1.01 * smallest_cos_pitch).error().message();
}

TEST(NeuroDomain, entry_beside_the_axis_of_the_pose_is_refused) {
  const NeuroJoints joints = forward_cases[1].joints;
  const Pose pose = *neuro().zframe_from_treatment(joints);
  const Pose entry = *neuro().zframe_from_entry(joints);
  const double length = (pose.translation() - entry.translation()).norm();
  const auto beside = [&](double angle) {
    return neuro().joints_for(pose, entry.translation() + angle * length * entry.linear().col(0));
  };
  ASSERT_TRUE(beside(0.9 * axis_tolerance));
  EXPECT_LE(distance(*neuro().zframe_from_treatment(*beside(0.9 * axis_tolerance)), pose), exact)
      << "the pose is met, not the slip of the entry";
  EXPECT_EQ(beside(1.1 * axis_tolerance).error().code, Code::off_axis);
  const Vector3d behind = pose.translation() + 10.0 * pose.linear().col(2);
  EXPECT_EQ(neuro().joints_for(pose, behind).error().code, Code::off_axis);
}

TEST(NeuroDomain, geometry_without_a_working_trapezoid_is_refused) {
  const auto refusal = [](auto change) {
    NeuroRcm geometry = neuro_geometry();
    change(geometry);
    const auto created = NeuroKinematics::create(geometry, neuro_probe());
    return created ? std::string_view("accepted") : created.error().quantity;
  };
  EXPECT_EQ(refusal([](NeuroRcm& geometry) { geometry.side_link_mm = 0.0; }), "side_link_mm");
  EXPECT_EQ(refusal([](NeuroRcm& geometry) { geometry.top_width_mm = NAN; }), "top_width_mm");
  EXPECT_EQ(refusal([](NeuroRcm& geometry) { geometry.min_separation_mm = 30.0; }), "min_separation_mm");
  EXPECT_EQ(refusal([](NeuroRcm& geometry) { geometry.max_separation_mm = 150.0; }), "max_separation_mm");
  EXPECT_EQ(refusal([](NeuroRcm& geometry) { geometry.max_separation_mm = 74.0; }), "max_separation_mm");
  EXPECT_EQ(refusal([](NeuroRcm& geometry) { geometry.home_separation_mm = 147.0; }), "home_separation_mm");
  EXPECT_EQ(refusal([](NeuroRcm& geometry) { geometry.home_rcm_mm[2] = INFINITY; }), "home_rcm_mm.z");
  EXPECT_EQ(refusal([](NeuroRcm&) {}), "accepted");
}

}  // namespace
}  // namespace interlock::test
