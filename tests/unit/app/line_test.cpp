/** @file Straight lines of the treatment point: planned, refused, and as the plant goes along them. */
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "closed_loop.hpp"
#include "proposals/line_program.hpp"
#include "robot/robot_file.hpp"

namespace interlock {
namespace {

using Eigen::Vector3d;
using test::ClosedLoop;
using testing::HasSubstr;
using Counts = std::map<std::string, std::int32_t>;

const Robot& gantry() {
  static const Robot robot = load_robot(INTERLOCK_TEST_ROBOTS "/gantry.toml").value();
  return robot;
}

std::size_t place_of(const Robot& robot, std::string_view axis) {
  return static_cast<std::size_t>(robot.find(axis) - robot.axes.data());
}

/** A robot, and where its axes stand. */
struct Standing {
  const Robot& robot;
  RobotKinematics kinematics;
  AxisPositions positions;

  [[nodiscard]] Pose pose() const { return kinematics.zframe_from_treatment(positions).value(); }
  /** The end of a line by so many mm across and along the probe. */
  [[nodiscard]] Vector3d beside(double x_mm, double y_mm, double z_mm) const {
    return pose() * Vector3d(x_mm, y_mm, z_mm);
  }
};

Standing standing_at(const Robot& robot, const Counts& counts) {
  Standing at{robot, RobotKinematics::create(robot).value(), {}};
  for (const Axis& axis : robot.axes) {
    const auto given = counts.find(axis.name);
    at.positions.push_back(axis.to_unit(given == counts.end() ? 0 : given->second));
  }
  return at;
}

const Counts neuro_counts{{"yaw", -500},     {"pitch", 120},  {"insertion", 500},
                          {"lateral", -900}, {"head", -2000}, {"feet", -400}};
const Counts gantry_counts{{"across", 1200}, {"up", 1200}, {"yaw", 200}, {"pitch", -300}, {"insertion", 800}};

/** Distances of a pose from a line and from what the probe keeps, worked out anew. */
struct Judge {
  Pose start;
  Vector3d end;
  std::optional<Vector3d> entry; /**< else the direction is kept */

  [[nodiscard]] double off_line_mm(const Pose& pose) const {
    const Vector3d along = (end - start.translation()).normalized();
    return along.cross(pose.translation() - start.translation()).norm();
  }
  [[nodiscard]] double off_entry_mm(const Pose& pose) const {
    return entry ? pose.linear().col(2).cross(*entry - pose.translation()).norm()
                 : 100.0 * pose.linear().col(2).cross(start.linear().col(2)).norm();
  }
};

TEST(StraightLine, StaysWithinItsDeviationEverywhereBetweenItsRows) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> far(-12.0, 12.0);
  int lines = 0;
  for (const Standing& at :
       {standing_at(test::neuro(), neuro_counts), standing_at(gantry(), gantry_counts)}) {
    for (int draw = 0; draw < 40; ++draw) {
      const std::optional<Vector3d> entry =
          draw % 2 == 0 ? std::optional(at.beside(0.0, 0.0, -60.0)) : std::nullopt;
      LineRequest request{at.beside(far(generator), far(generator), far(generator)), entry,
                          draw % 3 == 0 ? 1e-6 : 0.1, 5.0};
      if (&at.robot == &test::neuro()) {
        if (!entry) {
          continue;  // It is inserted.
        }
        request.entry_mm = entry_at(at.kinematics, at.positions);
      } else if (!entry) {
        request.end_mm = at.beside(0.0, 0.0, far(generator));
      }
      const auto program = line_program(at.robot, at.kinematics, at.positions, request);
      if (!program) {
        EXPECT_THAT(program.error().code,
                    testing::AnyOf("RANGE", "OUT_OF_REACH", "SEPARATION", "OUT_OF_RANGE"))
            << program.error().detail;
        continue;
      }
      ++lines;
      const Judge judge{at.pose(), request.end_mm, request.entry_mm};
      const TimedTrajectory& trajectory = std::get<TimedLeg>(program->legs.front()).trajectory;
      EXPECT_LE(program->line->planned_mm, request.deviation_mm);
      double worst_mm = 0.0;
      AxisPositions positions = at.positions;
      for (int sample = 0; sample <= 5000; ++sample) {
        for (std::size_t axis = 0; axis < trajectory.axes().size(); ++axis) {
          positions[place_of(at.robot, trajectory.axes()[axis].name)] =
              trajectory.at(axis, trajectory.end_s() * sample / 5000.0).position;
        }
        const Pose pose = at.kinematics.zframe_from_treatment(positions).value();
        worst_mm = std::max({worst_mm, judge.off_line_mm(pose), judge.off_entry_mm(pose)});
        if (sample == 5000) {
          EXPECT_LE((pose.translation() - request.end_mm).norm(), 1e-6);
        }
      }
      EXPECT_LE(worst_mm, program->line->planned_mm + 1e-9);
      for (std::size_t axis = 0; axis < trajectory.axes().size(); ++axis) {
        const MotionRates rates = *at.robot.find(trajectory.axes()[axis].name)->motion;
        const RateLimits most = rates.in_units(at.robot.find(trajectory.axes()[axis].name)->counts_per_unit);
        EXPECT_LE(trajectory.axes()[axis].top.velocity, most.velocity * (1.0 + 1e-6));
        EXPECT_LE(trajectory.axes()[axis].top.acceleration, most.acceleration * (1.0 + 1e-6));
        EXPECT_LE(trajectory.axes()[axis].top.jerk, most.jerk * (1.0 + 1e-6));
      }
    }
  }
  EXPECT_GE(lines, 25);
}

TEST(StraightLine, AlongTheProbeOfTheNeuroMovesItsInsertionAlone) {
  const Standing at = standing_at(test::neuro(), neuro_counts);
  const auto program =
      line_program(at.robot, at.kinematics, at.positions,
                   {at.beside(0.0, 0.0, 8.0), entry_at(at.kinematics, at.positions), 0.01, 5.0});
  ASSERT_TRUE(program) << program.error().detail;
  const TimedTrajectory& trajectory = std::get<TimedLeg>(program->legs.front()).trajectory;
  ASSERT_EQ(trajectory.axes().size(), 1U);
  EXPECT_EQ(trajectory.axes().front().name, "insertion");
}

std::string refusal(const Standing& at, const LineRequest& request) {
  const auto program = line_program(at.robot, at.kinematics, at.positions, request);
  return program ? "none" : program.error().code + ": " + program.error().detail;
}

TEST(StraightLine, IsRefusedWithThePlaceOnItWhereAnAxisOrThePoseEnds) {
  const Standing neuro = standing_at(test::neuro(), neuro_counts);
  const auto entry = entry_at(neuro.kinematics, neuro.positions);
  EXPECT_THAT(refusal(neuro, {neuro.beside(0.0, 0.0, 40.0), entry, 0.1, 5.0}),
              testing::AllOf(HasSubstr("RANGE: At "),
                             HasSubstr("mm of the line's 40 mm: Probe insertion would be at")));
  EXPECT_THAT(refusal(neuro, {neuro.beside(0.0, 80.0, 0.0), entry, 0.1, 5.0}),
              HasSubstr("of the line's 80 mm: "));
  EXPECT_THAT(refusal(neuro, {neuro.beside(0.0, 0.0, 0.01), entry, 0.1, 5.0}),
              HasSubstr("The line is 0.01 mm long"));
  EXPECT_THAT(refusal(neuro, {neuro.beside(5.0, 0.0, 0.0), std::nullopt, 0.1, 5.0}), HasSubstr("INSERTED: "));
  EXPECT_THAT(refusal(neuro, {neuro.beside(5.0, 0.0, 0.0), neuro.beside(2.0, 0.0, -50.0), 0.1, 5.0}),
              HasSubstr("OFF_AXIS: The probe's axis passes 2 mm beside"));
  EXPECT_THAT(refusal(neuro, {neuro.beside(5.0, 0.0, 0.0), neuro.beside(0.0, 0.0, 50.0), 0.1, 5.0}),
              HasSubstr("OFF_AXIS: "));

  Counts steep = gantry_counts;
  steep["insertion"] = 100;
  const Standing chain = standing_at(gantry(), steep);
  EXPECT_THAT(refusal(chain, {chain.beside(100.0, 0.0, 0.0), std::nullopt, 0.1, 5.0}), HasSubstr("INSERTED"));
  EXPECT_THAT(refusal(chain, {chain.beside(0.0, 0.0, 90.0), std::nullopt, 0.1, 5.0}),
              HasSubstr("of the line's 90 mm: "));
}

TEST(StraightLine, PastASingularPoseIsRefused) {
  // The probe of the neuro through an entry point straight beside it: yaw is undetermined at a pitch of 90
  // degrees.
  Robot loose = test::neuro();
  for (Axis& axis : loose.axes) {
    axis.soft_limits = {-100000, 100000};
    axis.limit = ILK_LIMIT_NONE;
  }
  Counts counts = neuro_counts;
  counts["pitch"] = static_cast<std::int32_t>(1.40 * loose.find("pitch")->counts_per_unit);
  const Standing at = standing_at(loose, counts);
  const auto entry = entry_at(at.kinematics, at.positions);
  const double depth_mm = *at.kinematics.depth_mm(at.positions);
  EXPECT_THAT(refusal(at, {at.beside(2.0 * depth_mm * std::tan(0.17), 0.0, 0.0), entry, 0.1, 5.0}),
              HasSubstr("SINGULAR: At "));
}

struct Ran {
  double off_line_mm = 0.0;
  double off_entry_mm = 0.0;
  double planned_mm = 0.0;
};

/** Carries a line out and judges where the plant truly was in every tick. */
Ran run(const Robot& robot, const Counts& counts, std::uint64_t seed,
        const std::function<LineRequest(const Standing&)>& asked) {
  ClosedLoop loop(seed, 2, robot);
  if (std::ranges::all_of(robot.axes, [](const Axis& axis) { return axis.homing.has_value(); })) {
    for (const Axis& axis : robot.axes) {
      loop.make_ready(axis.slot);
    }
  } else {
    loop.make_all_ready();
  }
  Standing at = standing_at(robot, {});
  std::vector<double> offsets;
  MoveLeg approach;
  for (const Axis& axis : robot.axes) {
    offsets.push_back(loop.true_position(axis.slot) - loop.state().axis[axis.slot].position_counts);
    const auto given = counts.find(axis.name);
    if (given != counts.end()) {
      approach.targets.push_back({axis.slot, given->second});
    }
  }
  EXPECT_EQ(loop.carry_out(1, test::along(PathProgram{{approach}}), test::minute_ticks).phase,
            TaskPhase::done);
  loop.run(200);
  for (std::size_t place = 0; place < at.positions.size(); ++place) {
    at.positions[place] =
        robot.axes[place].to_unit(loop.state().axis[robot.axes[place].slot].position_counts);
  }
  const LineRequest request = asked(at);
  const auto program = line_program(robot, at.kinematics, at.positions, request);
  EXPECT_TRUE(program) << program.error().detail;
  if (!program) {
    return {};
  }
  const Judge judge{at.pose(), request.end_mm, request.entry_mm};
  Ran ran{0.0, 0.0, program->line->planned_mm};
  loop.watch([&] {
    AxisPositions real;
    for (std::size_t place = 0; place < robot.axes.size(); ++place) {
      const Axis& axis = robot.axes[place];
      real.push_back((loop.true_position(axis.slot) - offsets[place]) / axis.counts_per_unit);
    }
    const Pose pose = at.kinematics.zframe_from_treatment(real).value();
    ran.off_line_mm = std::max(ran.off_line_mm, judge.off_line_mm(pose));
    ran.off_entry_mm = std::max(ran.off_entry_mm, judge.off_entry_mm(pose));
  });
  const TaskStatus ended = loop.carry_out(2, test::along(*program), test::minute_ticks);
  EXPECT_EQ(ended.phase, TaskPhase::done) << robot.name << ": reason " << static_cast<int>(ended.reason)
                                          << ", code " << ended.code << ", slot " << ended.slot;
  EXPECT_EQ(loop.refusals(), 0U);
  return ran;
}

/** By docs/paths.md: of the treatment point from its line, and of the probe's axis from its entry. */
constexpr double line_mm = 0.12;
constexpr double entry_mm = 0.2;

class StraightLineOnThePlant : public testing::TestWithParam<double> {};

TEST_P(StraightLineOnThePlant, TheTreatmentPointStaysNearItsLineAndTheProbeNearWhatItKeeps) {
  const double speed = GetParam();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const std::map<std::string, Ran> runs{
        {"neuro, about its entry", run(test::neuro(), neuro_counts, seed,
                                       [&](const Standing& at) {
                                         return LineRequest{at.beside(6.0, -5.0, 4.0),
                                                            entry_at(at.kinematics, at.positions), 0.05,
                                                            speed};
                                       })},
        {"neuro, ahead", run(test::neuro(), neuro_counts, seed,
                             [&](const Standing& at) {
                               return LineRequest{at.beside(0.0, 0.0, 10.0),
                                                  entry_at(at.kinematics, at.positions), 0.05, speed};
                             })},
        {"gantry, about an entry", run(gantry(), gantry_counts, seed,
                                       [&](const Standing& at) {
                                         return LineRequest{at.beside(8.0, 6.0, 10.0),
                                                            at.beside(0.0, 0.0, -60.0), 0.05, speed};
                                       })},
        {"gantry, ahead", run(gantry(), gantry_counts, seed, [&](const Standing& at) {
           return LineRequest{at.beside(0.0, 0.0, 20.0), std::nullopt, 0.05, speed};
         })}};
    for (const auto& [name, ran] : runs) {
      RecordProperty(name + ", line", std::to_string(ran.off_line_mm));
      RecordProperty(name + ", entry", std::to_string(ran.off_entry_mm));
      EXPECT_LE(ran.off_line_mm, line_mm) << name << ", seed " << seed;
      EXPECT_LE(ran.off_entry_mm, entry_mm) << name << ", seed " << seed;
      EXPECT_GT(ran.off_line_mm, 0.0) << name << ": nothing was seen to move";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(MmPerSecond, StraightLineOnThePlant, testing::Values(2.0, 5.0, 20.0));

}  // namespace
}  // namespace interlock
