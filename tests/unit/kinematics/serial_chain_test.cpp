/** @file A chain of joints from a robot file, as KDL solves it, held against closed forms written here. */
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "kinematics/kinematics.hpp"
#include "random_joints.hpp"
#include "robot/robot_file.hpp"
#include "robot/table_reader.hpp"

namespace interlock {

KinematicsPtr read_serial_chain(TableReader& table);

namespace test {
namespace {

using Eigen::Vector3d;
using testing::AnyOf;
using testing::HasSubstr;
using Code = KinematicsError::Code;

/** The chain of a [kinematics] table without its `family`, or why it is refused. */
tl::expected<KinematicsPtr, RobotError> chain_of(const std::string& text) {
  const toml::table root = toml::parse(text);
  ReadLog log;
  TableReader table(log, root, "kinematics");
  KinematicsPtr chain = read_serial_chain(table);
  table.refuse_unknown_keys();
  return log.first_error ? tl::expected<KinematicsPtr, RobotError>(tl::unexpected(*log.first_error)) : chain;
}

std::string joint(const std::string& axis, const std::string& type, const std::string& xyz,
                  const std::string& direction, const std::string& limits) {
  return "[[joint]]\naxis = \"" + axis + "\"\ntype = \"" + type + "\"\nxyz_mm = " + xyz +
         "\nrpy_rad = [0.0, 0.0, 0.0]\ndirection = " + direction + "\n" + limits + "\n";
}

const std::string tool = "tool = { xyz_mm = [0.0, 0.0, 100.0], rpy_rad = [0.0, 0.0, 0.0] }\n";

/** Shoulder, elbow and a wrist of three, all revolute: links of 200 and 150 mm. */
KinematicsPtr arm_with_base(const std::string& base_limits) {
  return chain_of(tool +
                  joint("base", "revolute", "[0, 0, 100]", "[0, 0, 1]", "limits_rad = " + base_limits) +
                  joint("shoulder", "revolute", "[0, 0, 0]", "[0, 1, 0]", "limits_rad = [-2.0, 2.0]") +
                  joint("elbow", "revolute", "[0, 0, 200]", "[0, 1, 0]", "limits_rad = [0.1, 2.5]") +
                  joint("roll", "revolute", "[0, 0, 150]", "[0, 0, 1]", "limits_rad = [-3.0, 3.0]") +
                  joint("bend", "revolute", "[0, 0, 0]", "[0, 1, 0]", "limits_rad = [-2.0, 2.0]") +
                  joint("turn", "revolute", "[0, 0, 0]", "[0, 0, 1]", "limits_rad = [-3.0, 3.0]"))
      .value();
}

const KinematicsPtr& arm() {
  static const KinematicsPtr chain = arm_with_base("[-3.0, 3.0]");
  return chain;
}

/** tests/integration/robots/gantry.toml: across, up, yaw, pitch, insertion. */
const KinematicsPtr& gantry() {
  static const Robot robot = load_robot(INTERLOCK_TEST_ROBOTS "/gantry.toml").value();
  return robot.kinematics;
}

Pose gantry_pose(const std::vector<double>& q) {
  Pose pose(Eigen::Translation3d(30.0 + q[0], 40.0 + q[1], 10.0));
  pose.linear() = rotation_y(q[2]);
  pose.translate(Vector3d(0.0, 0.0, 25.0));
  pose.rotate(rotation_x(q[3]));
  pose.translate(Vector3d(0.0, -15.0, q[4] + 100.0));
  return pose;
}

/** Joints of the gantry for a direction and a target, in closed form. */
std::vector<double> gantry_joints(const Vector3d& ahead, const Vector3d& target) {
  const double yaw = std::atan2(ahead.x(), ahead.z());
  const double pitch = std::atan2(-ahead.y(), std::hypot(ahead.x(), ahead.z()));
  const Eigen::Matrix3d rotation = rotation_y(yaw) * rotation_x(pitch);
  const Vector3d gimbal = rotation_y(yaw) * Vector3d(0.0, 0.0, 25.0) + rotation * Vector3d(0.0, -15.0, 0.0);
  const double length = (target.z() - 10.0 - gimbal.z()) / ahead.z();
  const Vector3d base = target - gimbal - length * ahead;
  return {base.x() - 30.0, base.y() - 40.0, yaw, pitch, length - 100.0};
}

std::vector<double> drawn(std::mt19937_64& generator, std::span<const std::pair<double, double>> ranges) {
  std::vector<double> joints;
  for (const auto& [lowest, highest] : ranges) {
    joints.push_back(std::uniform_real_distribution<double>(lowest, highest)(generator));
  }
  return joints;
}

constexpr std::pair<double, double> gantry_ranges[] = {{0, 60}, {0, 60}, {-0.6, 0.6}, {-0.6, 0.6}, {0, 60}};
constexpr std::pair<double, double> arm_ranges[] = {{-2.9, 2.9}, {-1.9, 1.9}, {0.3, 2.4},
                                                    {-2.9, 2.9}, {0.2, 1.9},  {-2.9, 2.9}};

TEST(SerialChain, forward_agrees_with_the_product_of_its_matrices) {
  std::mt19937_64 generator(1);
  for (int sample = 0; sample < 1000; ++sample) {
    const std::vector<double> joints = drawn(generator, gantry_ranges);
    EXPECT_LE(distance(*gantry()->zframe_from_treatment(joints), gantry_pose(joints)), 1e-9);
  }
}

TEST(SerialChain, jacobian_agrees_with_central_differences_in_mm_and_rad) {
  constexpr double moved = 1e-5;
  std::mt19937_64 generator(9);
  const auto expect_agreement = [&](const KinematicsPtr& chain, const std::vector<double>& joints) {
    const Jacobian jacobian = chain->jacobian(joints).value();
    ASSERT_EQ(jacobian.cols(), static_cast<Eigen::Index>(joints.size()));
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
      std::vector<double> before = joints;
      std::vector<double> after = joints;
      before[joint] -= moved;
      after[joint] += moved;
      const Pose from = *chain->zframe_from_treatment(before);
      const Pose to = *chain->zframe_from_treatment(after);
      const Eigen::Matrix3d turn = to.linear() * from.linear().transpose();
      Eigen::Matrix<double, 6, 1> motion;
      motion << to.translation() - from.translation(),
          Vector3d(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)) / 2.0;
      EXPECT_LE((jacobian.col(static_cast<Eigen::Index>(joint)) - motion / (2.0 * moved)).norm(), 1e-6);
    }
  };
  for (int sample = 0; sample < 100; ++sample) {
    expect_agreement(gantry(), drawn(generator, gantry_ranges));
    expect_agreement(arm(), drawn(generator, arm_ranges));
  }
}

TEST(SerialChain, inverse_of_a_path_agrees_with_the_closed_form) {
  std::mt19937_64 generator(2);
  for (int sample = 0; sample < 300; ++sample) {
    const Pose pose = gantry_pose(drawn(generator, gantry_ranges));
    const Vector3d target = pose.translation();
    const Vector3d ahead = pose.linear().col(2);
    const auto found = gantry()->positions_for(target - 50.0 * ahead, target, 0.0);
    ASSERT_TRUE(found) << found.error().message();
    const std::vector<double> expected = gantry_joints(ahead, target);
    for (std::size_t index = 0; index < expected.size(); ++index) {
      EXPECT_NEAR((*found)[index], expected[index], 2e-6) << index;
    }
  }
}

TEST(SerialChain, inverse_of_a_pose_of_six_joints_leads_to_the_pose_within_the_limits) {
  std::mt19937_64 generator(3);
  for (int sample = 0; sample < 300; ++sample) {
    const Pose pose = *arm()->zframe_from_treatment(drawn(generator, arm_ranges));
    const auto found = arm()->positions_for(pose, std::nullopt);
    ASSERT_TRUE(found) << sample << ": " << found.error().message();
    EXPECT_LE(distance(*arm()->zframe_from_treatment(*found), pose), 2e-6);
    EXPECT_GE((*found)[2], 0.1 - 1e-9);
    EXPECT_LE((*found)[2], 2.5 + 1e-9);
    EXPECT_LE(std::abs((*found)[4]), 2.0 + 1e-9);
  }
}

TEST(SerialChain, turns_the_probe_by_the_last_joint_and_refuses_a_rotation_without_one) {
  const Pose pose = *arm()->zframe_from_treatment(std::vector{0.3, 0.4, 1.0, 0.2, 0.7, 0.0});
  const Vector3d entry = pose * Vector3d(0.0, 0.0, -50.0);
  EXPECT_EQ(arm()->positions_for(entry, pose.translation(), 0.5)->back(), 0.5);
  EXPECT_EQ(arm()->positions_for(entry, pose.translation(), 3.1).error().quantity, "turn_rad");
  const auto refused = gantry()->positions_for({50, 60, 50}, {50, 60, 150}, 0.5);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().quantity, "rotation_rad");
}

TEST(SerialChain, beyond_a_limit_or_all_links_is_out_of_reach_and_names_how_far) {
  const std::vector<double> deep{30.0, 30.0, 0.0, 0.0, 70.0};
  const Vector3d target = gantry_pose(deep).translation();
  const auto beyond = gantry()->positions_for(target - Vector3d(0, 0, 50), target, 0.0);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, Code::out_of_reach);
  EXPECT_EQ(beyond.error().quantity, "insertion_mm");
  EXPECT_NEAR(*beyond.error().value, 70.0, 1e-5);
  EXPECT_EQ(beyond.error().highest, 60.0);
  const auto far = arm()->positions_for({0, 0, 900}, {0, 0, 1000}, 0.0);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, Code::out_of_reach);
  EXPECT_EQ(far.error().quantity, "distance_from_base_mm");
  EXPECT_NEAR(*far.error().value, 900.0, 1e-9);
  EXPECT_NEAR(far.error().highest, 450.0, 1e-9);
}

TEST(SerialChain, pose_that_its_joints_cannot_turn_to_is_refused) {
  Pose rolled = gantry_pose({30, 30, 0.1, 0.2, 30});
  rolled.rotate(rotation_z(0.5));
  const auto refused = gantry()->positions_for(rolled, std::nullopt);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().code == Code::out_of_reach || refused.error().code == Code::not_converged);
  EXPECT_GT(*refused.error().value, refused.error().highest) << refused.error().message();
}

TEST(SerialChain, pose_that_leaves_a_joint_undetermined_is_singular) {
  // Bend at 0: roll and turn about the same line. The base cannot turn to where the arm reaches over itself.
  const KinematicsPtr forward_only = arm_with_base("[-1.0, 1.0]");
  const Pose pose = *forward_only->zframe_from_treatment(std::vector{0.3, 0.4, 1.0, 0.2, 0.0, 0.1});
  const auto refused = forward_only->positions_for(pose, std::nullopt);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::singular) << refused.error().message();
}

TEST(SerialChain, numbers_that_are_none_come_back_as_errors) {
  const double nan = std::nan("");
  EXPECT_EQ(gantry()->zframe_from_treatment(std::vector{0.0, nan, 0.0, 0.0, 0.0}).error().quantity, "up_mm");
  EXPECT_EQ(gantry()->zframe_body(std::vector{0.0, 0.0, 0.0, 0.0, HUGE_VAL}).error().code, Code::not_finite);
  EXPECT_EQ(gantry()->zframe_from_treatment(std::vector{0.0, 0.0, 2e3, 0.0, 0.0}).error().code,
            Code::out_of_range);
  EXPECT_FALSE(gantry()->positions_for({0, 0, nan}, {0, 0, 100}, 0.0));
  EXPECT_FALSE(gantry()->positions_for({0, 0, 100}, {0, 0, 100}, 0.0));
  EXPECT_FALSE(gantry()->positions_for({50, 60, 50}, {50, 60, 150}, nan));
  Pose skew = Pose::Identity();
  skew.linear()(0, 0) = 2.0;
  EXPECT_EQ(gantry()->positions_for(skew, std::nullopt).error().code, Code::not_rigid);
}

TEST(SerialChain, parts_of_its_body_meet_and_the_probe_ends_at_the_tip) {
  const auto chain = gantry()->with_probe({2.0, 0.0, 0.0, 0.0}).value();
  const std::vector<double> joints{20.0, 30.0, 0.2, -0.3, 40.0};
  const RobotBody body = *chain->zframe_body(joints);
  for (std::size_t part = 1; part < body.size(); ++part) {
    EXPECT_LE((body[part].from_mm - body[part - 1].to_mm).norm(), 1e-9);
  }
  EXPECT_EQ(body.back().name, "probe");
  EXPECT_LE((body.back().to_mm - gantry_pose(joints) * Vector3d(0, 0, 2)).norm(), 1e-9);
}

std::string three(std::mt19937_64& generator, double farthest) {
  std::uniform_real_distribution<double> anywhere(-farthest, farthest);
  std::string text;
  for (int number = 0; number < 3; ++number) {
    text += (text.empty() ? "[" : ", ") + std::to_string(anywhere(generator));
  }
  return text + "]";
}

TEST(SerialChain, of_any_joints_answers_with_what_forward_kinematics_confirms_or_an_error) {
  std::mt19937_64 generator(4);
  const std::string directions[] = {"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"};
  std::size_t solved = 0;
  for (int number = 0; number < 100; ++number) {
    std::string text = tool;
    const auto count = 1 + generator() % 7;
    for (std::size_t index = 0; index < count; ++index) {
      const bool slides = generator() % 3 == 0;
      text += joint("j" + std::to_string(index), slides ? "prismatic" : "revolute", three(generator, 100.0),
                    directions[generator() % 3], slides ? "limits_mm = [0, 80]" : "limits_rad = [-2, 2]");
    }
    const auto read = chain_of(text);
    if (!read) {
      EXPECT_THAT(read.error().problem,
                  AnyOf(HasSubstr("only as those before it do"), HasSubstr("turns about its z axis")));
      continue;
    }
    const KinematicsPtr& chain = *read;
    const Pose home = *chain->zframe_from_treatment(std::vector<double>(count, 0.5));
    for (const Pose& pose : {home, random_pose(generator, 300.0)}) {
      const Vector3d target = pose.translation();
      const Vector3d ahead = pose.linear().col(2);
      const auto found = chain->positions_for(target - 20.0 * ahead, target, 0.0);
      solved += found ? 1 : 0;
      if (found) {
        const Pose reached = *chain->zframe_from_treatment(*found);
        EXPECT_LE((reached.translation() - target).norm(), 2e-6) << text;
        EXPECT_LE((reached.linear().col(2) - ahead).norm(), 1e-8) << text;
      } else {
        EXPECT_TRUE(!found.error().value || std::isfinite(*found.error().value)) << found.error().message();
      }
    }
  }
  EXPECT_GT(solved, 10U);
}

TEST(SerialChain, that_is_singular_everywhere_is_refused_at_the_joint_that_adds_nothing) {
  const std::string turn = "limits_rad = [-2, 2]";
  const std::string slide = "limits_mm = [0, 80]";
  const std::string base = tool + joint("base", "revolute", "[0, 0, 50]", "[0, 0, 1]", turn);
  const std::string singular[] = {
      base + joint("again", "revolute", "[0, 0, 80]", "[0, 0, -1]", turn),
      base + joint("turned", "revolute", "[0, 70, 0]", "[0, 1, 0]", turn) +
          joint("again", "revolute", "[0, 30, 0]", "[0, 1, 0]", turn),
      base + joint("out", "prismatic", "[10, 0, 0]", "[1, 0, 0]", slide) +
          joint("again", "prismatic", "[0, 20, 9]", "[1, 0, 0]", slide),
      base + joint("second", "revolute", "[90, 0, 0]", "[0, 0, 1]", turn) +
          joint("third", "revolute", "[80, 0, 0]", "[0, 0, 1]", turn) +
          joint("again", "revolute", "[70, 0, 0]", "[0, 0, 1]", turn),
  };
  for (const std::string& text : singular) {
    const auto refused = chain_of(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().key, "kinematics.joint.again.direction");
    EXPECT_EQ(refused.error().problem,
              "an array is given: the joint moves the tool only as those before it do");
    EXPECT_GT(refused.error().line, 0U);
  }
}

TEST(SerialChain, whose_paths_leave_a_joint_undetermined_is_refused) {
  const std::string rotation =
      joint("rotation", "revolute", "[0, 0, 0]", "[0, 0, 1]", "limits_rad = [-2, 2]");
  const std::string insertion =
      joint("insertion", "prismatic", "[0, 0, 0]", "[0, 0, 1]", "limits_mm = [0, 60]");
  EXPECT_TRUE(chain_of(tool + insertion + rotation));
  const auto refused = chain_of(tool + rotation + insertion);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().key, "kinematics.joint");
  EXPECT_THAT(refused.error().expected, HasSubstr("a last joint that turns it about its z axis"));
}

struct Broken {
  std::string from;
  std::string to;
  std::string error;
};

TEST(SerialChain, impossible_numbers_are_refused_where_they_stand) {
  const std::string text =
      tool + joint("slide", "prismatic", "[0, 0, 1]", "[0, 0, 1]", "limits_mm = [0, 60]");
  ASSERT_TRUE(chain_of(text));
  const Broken broken[] = {
      {"prismatic", "linear", "kinematics.joint.slide.type: 'linear' is given"},
      {"[0, 60]", "[60, 0]", "kinematics.joint.slide.limits_mm: an array is given: these are no limits"},
      {"[0, 60]", "[0, nan]", "kinematics.joint.slide.limits_mm: nan is given"},
      {"[0, 60]", "[0, 1e9]", "kinematics.joint.slide.limits_mm: an array is given: these are no limits"},
      {"limits_mm", "limits_rad", "kinematics.joint.slide.limits_mm: the key is missing"},
      {"direction = [0, 0, 1]", "direction = [0, 0, 0]",
       "kinematics.joint.slide.direction: an array is given: it is not"},
      {"direction = [0, 0, 1]", "direction = [0, 1]",
       "kinematics.joint.slide.direction: 2 entries are given"},
      {"xyz_mm = [0, 0, 1]", "xyz_mm = [0, 0, 1e4]",
       "kinematics.joint.slide.xyz_mm: an array is given: a coordinate"},
      {"[0, 0, 1]", "[0, 0, inf]", "kinematics.joint.slide.xyz_mm: inf is given"},
      {"[0.0, 0.0, 0.0]", "[0.0, 0.0, 90.0]", "kinematics.tool.rpy_rad: an array is given: an angle"},
      {"\"slide\"", "\"Slide\"", "axis: 'Slide' is given"},
      {"axis =", "drive = 1\naxis =", "kinematics.joint.slide.drive: the key is unknown"},
  };
  for (const Broken& each : broken) {
    std::string edited = text;
    edited.replace(edited.find(each.from), each.from.size(), each.to);
    const auto refused = chain_of(edited);
    ASSERT_FALSE(refused) << each.to;
    EXPECT_THAT(refused.error().message(), HasSubstr(each.error));
  }
  const auto twice = chain_of(text + text.substr(tool.size()));
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().message(), HasSubstr("\"slide\" moves another joint already"));
  EXPECT_THAT(chain_of(tool + "joint = []").error().message(), HasSubstr("0 joints are given"));
}

}  // namespace
}  // namespace test
}  // namespace interlock
