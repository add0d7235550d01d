/** @file The prostate robot's kinematics give the reference values, invert exactly and refuse what is
 * outside. */
#include "kinematics/prostate_trapezoids/prostate_kinematics.hpp"

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

Pose angulated_pose(const Vector3d& tip, double yaw_rad, double pitch_rad) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation_y(yaw_rad) * rotation_x(pitch_rad);
  pose.translation() = tip;
  return pose;
}

ProstateKinematics thesis() { return ProstateKinematics::create(thesis_prostate_geometry()).value(); }

/** Sliders of both stages alike; `separation` of each pair. */
ProstateJoints parallel(double separation_mm) {
  const double half = separation_mm / 2.0;
  return {half, -half, half, -half, 0.0, 0.0};
}

TEST(ProstateForward, home_sliders_give_the_reference_height) {
  EXPECT_NEAR(thesis().base_from_tip(parallel(300.0))->translation().y(), 140.426185, reference_digits);
}

TEST(ProstateForward, gives_the_reference_tip_and_pitch) {
  const Pose pose = *prostate().base_from_tip({140, -120, 150, -130, 80, 0});
  expect_near(pose.translation(), {10, 185.897398, 288.403407}, reference_digits);
  const Vector3d advance = pose.linear().col(2);
  EXPECT_NEAR(std::atan2(advance.x(), advance.z()), 0.0, exact);
  EXPECT_NEAR(std::asin(-advance.y()) / degree, -3.590135, reference_digits);
}

TEST(ProstateForward, thesis_form_carries_the_insertion_along_z) {
  const Pose pose = *thesis().base_from_tip({155, -145, 155, -145, 40.925, 0});
  EXPECT_TRUE(pose.linear().isIdentity(1e-15));
  expect_near(pose.translation(), {5, 140.426185, 300}, reference_digits);
}

TEST(ProstateForward, needle_guide_lies_on_the_needle_and_does_not_follow_the_insertion) {
  ProstateJoints joints{140, -120, 150, -130, 80, 0.7};
  const Pose tip = *prostate().base_from_tip(joints);
  const Pose guide = *prostate().base_from_needle_guide(joints);
  expect_near(tip.translation(), guide.translation() + (224.0 + 80.0 - 223.4) * guide.linear().col(2), 1e-12);
  joints.insertion_mm = 0.0;
  EXPECT_EQ(prostate().base_from_needle_guide(joints)->translation(), guide.translation());
}

TEST(ProstateForward, rotation_is_proper_for_random_joints) {
  const ProstateKinematics kinematics = prostate();
  std::mt19937_64 generator(1);
  for (int trip = 0; trip < round_trips; ++trip) {
    const auto pose = kinematics.base_from_tip(random_prostate_joints(generator));
    if (pose) {
      const Matrix3d rotation = pose->linear();
      ASSERT_LE((rotation.transpose() * rotation - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
      ASSERT_NEAR(rotation.determinant(), 1.0, 1e-14);
    } else {
      ASSERT_EQ(pose.error().code, Code::out_of_range) << pose.error().message();
    }
  }
}

TEST(ProstateInverse, gives_the_reference_joints_of_the_thesis) {
  const auto joints = thesis().joints_for(Vector3d(5, 150, 300));
  ASSERT_TRUE(joints) << joints.error().message();
  EXPECT_LE(distance(*joints, {149.008578, -139.008578, 149.008578, -139.008578, 40.925, 0}),
            reference_digits);
}

TEST(ProstateInverse, gives_the_reference_joints_with_angulation) {
  const Pose pose = angulated_pose({10, 150, 400}, 5 * degree, -3 * degree);
  EXPECT_EQ(prostate().joints_for(pose).error().code, Code::separation)
      << "its front pair stands 312.1 mm apart";
  ProstateTrapezoids wider = prostate_geometry();
  wider.max_separation_mm = 320.0;
  const auto joints = ProstateKinematics::create(wider)->joints_for(pose);
  ASSERT_TRUE(joints) << joints.error().message();
  EXPECT_LE(distance(*joints, {129.742438, -182.358028, 117.480666, -201.854641, 193.156932, 0}),
            reference_digits);
}

TEST(ProstateInverse, undoes_forward) {
  std::mt19937_64 generator(2);
  ProstateTrapezoids offset_needle = prostate_geometry();
  offset_needle.needle_height_mm = 7.0;
  for (const ProstateTrapezoids& geometry : {prostate_geometry(), offset_needle}) {
    const ProstateKinematics kinematics = ProstateKinematics::create(geometry).value();
    double worst_joints = 0.0;
    double worst_pose = 0.0;
    for (int trip = 0; trip < round_trips;) {
      const ProstateJoints joints = random_prostate_joints(generator);
      const auto pose = kinematics.base_from_tip(joints);
      if (pose) {
        const auto found = kinematics.joints_for(*pose);
        ASSERT_TRUE(found) << found.error().message();
        worst_joints = std::max(worst_joints, distance(*found, joints));
        worst_pose = std::max(worst_pose, distance(*kinematics.base_from_tip(*found), *pose));
        ++trip;
      }
    }
    std::printf("prostate, needle at %.0f mm: worst joint error %.3g, worst pose error %.3g\n",
                geometry.needle_height_mm, worst_joints, worst_pose);
    EXPECT_LE(worst_joints, exact);
    EXPECT_LE(worst_pose, exact);
  }
}

TEST(ProstateInverse, meets_entry_and_target) {
  const Vector3d entry(8, 160, 300);
  const Vector3d target(12, 155, 400);
  const auto joints = prostate().joints_for(entry, target, 0.5);
  ASSERT_TRUE(joints) << joints.error().message();
  const Pose pose = *prostate().base_from_tip(*joints);
  expect_near(pose.translation(), target, exact);
  expect_near(pose.linear().col(2), (target - entry).normalized(), 1e-12);
  EXPECT_EQ(joints->rotation_rad, 0.5);
}

TEST(ProstateInverse, target_alone_keeps_the_needle_parallel) {
  const Vector3d target(5, 150, 300);
  const auto joints = *prostate().joints_for(target);
  EXPECT_EQ(joints.front_left_mm, joints.back_left_mm);
  EXPECT_EQ(joints.front_right_mm, joints.back_right_mm);
  expect_near(prostate().base_from_tip(joints)->translation(), target, exact);
}

TEST(ProstatePublishedMistakes, inverse_does_not_forget_the_front_pivot) {
  const Vector3d target(5, 150, 400);
  const auto joints = *prostate().joints_for(target);
  EXPECT_NEAR(joints.insertion_mm, 400.0 - 224.0 + 15.0, exact) << "published: 15 mm short";
}

TEST(ProstatePublishedMistakes, stage_distance_is_measured_along_z_only) {
  const Pose pose = angulated_pose({10, 150, 400}, 5 * degree, 5 * degree);
  ProstateTrapezoids level = prostate_geometry();
  level.front_pivot_offset_mm = 0.0;
  const ProstateKinematics kinematics = ProstateKinematics::create(level).value();
  EXPECT_LE(distance(*kinematics.base_from_tip(*kinematics.joints_for(pose)), pose), exact)
      << "published: 0.30 mm beside";
}

TEST(ProstatePublishedMistakes, table_2_lateral_of_141_mm_is_unreachable_and_its_height_is_home) {
  EXPECT_FALSE(thesis().joints_for(Vector3d(0, 0, 300)));
  const auto home = *thesis().joints_for(Vector3d(0, 141, 300));
  EXPECT_NEAR(home.front_left_mm, 149.674, 1e-3);
}

TEST(ProstateDomain, separation_window_holds_from_both_sides) {
  const double rounding = 0.5 * boundary_slack;
  const double outside = 2.0 * boundary_slack;
  EXPECT_TRUE(prostate().base_from_tip(parallel(308.0 + rounding)));
  EXPECT_TRUE(prostate().base_from_tip(parallel(85.0 - rounding)));
  EXPECT_EQ(prostate().base_from_tip(parallel(308.0 + outside)).error().quantity, "front_separation_mm");
  EXPECT_EQ(prostate().base_from_tip(parallel(85.0 - outside)).error().code, Code::separation);
  ProstateJoints wide_back = parallel(308.0);
  wide_back.back_left_mm += outside;
  EXPECT_EQ(prostate().base_from_tip(wide_back).error().quantity, "back_separation_mm");
}

TEST(ProstateDomain, inverse_accepts_the_ends_of_the_window_and_refuses_beyond) {
  for (const double separation : {85.0, 308.0}) {
    const ProstateJoints end = parallel(separation);
    const Pose pose = *prostate().base_from_tip(end);
    const auto found = prostate().joints_for(pose);
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_LE(distance(*found, end), exact);
    Pose beyond = pose;
    beyond.translation().y() += separation == 85.0 ? 1e-6 : -1e-6;
    EXPECT_EQ(prostate().joints_for(beyond).error().code, Code::separation);
  }
}

TEST(ProstateDomain, height_beyond_the_links_is_out_of_reach) {
  const double pivots = 12.0 + 67.5;
  EXPECT_EQ(prostate().joints_for(Vector3d(0, pivots + 124.001, 400)).error().code, Code::out_of_reach);
  EXPECT_EQ(prostate().joints_for(Vector3d(0, pivots - 0.001, 400)).error().code, Code::out_of_reach);
}

TEST(ProstateDomain, angulation_is_limited_each_way_in_both_angles) {
  const double limit = prostate_geometry().max_angulation_rad;
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_TRUE(prostate().joints_for(angulated_pose({0, 170 - 60 * sign, 250}, 0, sign * limit)))
        << prostate()
               .joints_for(angulated_pose({0, 170 - 60 * sign, 250}, 0, sign * limit))
               .error()
               .message();
    EXPECT_TRUE(prostate().joints_for(angulated_pose({0, 160, 250}, sign * limit, 0)));
    const auto pitched = prostate().joints_for(angulated_pose({0, 160, 250}, 0, sign * (limit + 1e-6)));
    EXPECT_EQ(pitched.error().quantity, "needle_pitch_rad");
    const auto yawed = prostate().joints_for(angulated_pose({0, 160, 250}, sign * (limit + 1e-6), 0));
    EXPECT_EQ(yawed.error().quantity, "needle_yaw_rad");
  }
}

TEST(ProstateDomain, needle_pointing_backwards_or_sideways_is_refused) {
  EXPECT_EQ(prostate().joints_for(Vector3d(0, 160, 400), Vector3d(0, 160, 300)).error().quantity,
            "needle_yaw_rad");
  EXPECT_EQ(prostate().joints_for(Vector3d(0, 160, 400), Vector3d(0, 150, 400)).error().quantity,
            "needle_pitch_rad");
}

TEST(ProstateDomain, robot_of_the_thesis_refuses_stages_that_differ) {
  ProstateJoints joints = parallel(300.0);
  joints.back_left_mm += 1.0;
  EXPECT_EQ(thesis().base_from_tip(joints).error().quantity, "needle_yaw_rad");
  EXPECT_EQ(thesis().joints_for(angulated_pose({5, 150, 300}, 0, 0.01)).error().quantity, "needle_pitch_rad");
}

TEST(ProstateDomain, entry_on_the_target_is_degenerate) {
  const Vector3d target(0, 160, 400);
  EXPECT_EQ(prostate().joints_for(target, target).error().code, Code::degenerate);
  EXPECT_EQ(prostate().joints_for(target - Vector3d(0, 0, 0.99e-3), target).error().code, Code::degenerate);
  EXPECT_TRUE(prostate().joints_for(target - Vector3d(0, 0, 1.01e-3), target));
}

TEST(ProstateDomain, geometry_that_cannot_work_is_refused) {
  const auto refusal = [](auto change) {
    ProstateTrapezoids geometry = prostate_geometry();
    change(geometry);
    const auto created = ProstateKinematics::create(geometry);
    return created ? std::string_view("accepted") : created.error().quantity;
  };
  EXPECT_EQ(refusal([](ProstateTrapezoids& geometry) { geometry.stage_distance_mm = 0.0; }),
            "stage_distance_mm");
  EXPECT_EQ(refusal([](ProstateTrapezoids& geometry) { geometry.needle_tip_mm = NAN; }), "needle_tip_mm");
  EXPECT_EQ(refusal([](ProstateTrapezoids& geometry) { geometry.max_separation_mm = 332.0; }),
            "max_separation_mm");
  EXPECT_EQ(refusal([](ProstateTrapezoids& geometry) { geometry.max_angulation_rad = 1.1; }),
            "max_angulation_rad");
  EXPECT_EQ(refusal([](ProstateTrapezoids& geometry) { geometry.max_angulation_rad = -0.1; }),
            "max_angulation_rad");
  EXPECT_EQ(refusal([](ProstateTrapezoids&) {}), "accepted");
}

}  // namespace
}  // namespace interlock::test
