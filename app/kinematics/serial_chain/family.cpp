/**
 * @file
 * "serial_chain" of a robot file: joints in a row, each moved by one axis, as the file alone describes them.
 *
 * Each [[kinematics.joint]] stands in a fixed frame behind the one before it (xyz_mm, rpy_rad: about x, then
 * y, then z of the frame before, as in URDF) and turns about or slides along `direction` in its own frame.
 * The first frame is in the zFrame; `tool` is the treatment point behind the last joint.
 *
 * A path fixes a point and a direction but no rotation about it, so the chain that is searched for it ends in
 * a joint that turns freely: the last one when it turns the tool, else one more.
 */
#include <algorithm>
#include <array>
#include <cmath>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>

#include "kinematics/domain.hpp"
#include "kinematics/kinematics.hpp"
#include "kinematics/path.hpp"
#include "kinematics/serial_chain/search.hpp"
#include "robot/table_reader.hpp"

namespace interlock {
namespace {

using Code = KinematicsError::Code;
using Eigen::Vector3d;
using namespace serial_chain;

/** As many as a robot has slots. */
constexpr std::size_t most_joints = 10;

/** The chain with a joint more, which turns the tool about its z axis. */
KDL::Chain with_free_rotation(KDL::Chain chain) {
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ)));
  return chain;
}

/** Whether the last joint turns the tool about its own z axis and does nothing else. */
bool turns_the_tool(const std::vector<ChainJoint>& joints, const KDL::Frame& tool) {
  const ChainJoint& last = joints.back();
  const KDL::Vector along = last.direction / last.direction.Norm();
  return last.unit == Unit::rad && (tool.M.UnitZ() * along).Norm() < 1e-9 && (tool.p * along).Norm() < 1e-9;
}

/** All that the file says; shared by the copies with another probe, as names in errors point into it. */
struct Model {
  Model(std::vector<ChainJoint> described, const KDL::Frame& tool)
      : joints(std::move(described)),
        last_turns(turns_the_tool(joints, tool)),
        pose(chain_of(joints, tool), joints),
        path(last_turns ? pose.chain() : with_free_rotation(pose.chain()),
             std::span(joints).first(joints.size() - (last_turns ? 1 : 0))) {
    for (const ChainJoint& joint : joints) {
      const double limit = joint.unit == Unit::mm ? length_limit_mm : angle_limit_rad;
      listed.push_back({joint.axis,
                        joint.quantity,
                        joint.unit,
                        limit,
                        {{joint.lowest * joint.per_unit(), joint.highest * joint.per_unit()}}});
    }
  }

  std::vector<ChainJoint> joints;
  std::vector<Joint> listed;
  bool last_turns;
  Search pose;
  Search path;
};

class SerialChain final : public Kinematics {
 public:
  SerialChain(std::shared_ptr<const Model> model, const ProbeOffsets& probe)
      : model_(std::move(model)), probe_(probe) {}

  [[nodiscard]] std::span<const Joint> joints() const noexcept override { return model_->listed; }

  [[nodiscard]] KinematicsResult<KinematicsPtr> with_probe(const ProbeOffsets& probe) const override {
    return std::make_shared<const SerialChain>(model_, probe);
  }

  [[nodiscard]] KinematicsResult<Pose> zframe_from_treatment(
      std::span<const double> positions) const override {
    return kdl_joints(positions).map(
        [&](const KDL::JntArray& joints) { return pose_of(forward(model_->pose.chain(), joints)); });
  }

  [[nodiscard]] KinematicsResult<Jacobian> jacobian(std::span<const double> positions) const override {
    return kdl_joints(positions).map([&](const KDL::JntArray& joints) {
      KDL::Jacobian found(joints.rows());
      KDL::ChainJntToJacSolver(model_->pose.chain()).JntToJac(joints, found);
      Jacobian jacobian = found.data;
      for (std::size_t joint = 0; joint < model_->joints.size(); ++joint) {
        jacobian.col(static_cast<Eigen::Index>(joint)).head<3>() *=
            mm_per_m / model_->joints[joint].per_unit();
      }
      return jacobian;
    });
  }

  [[nodiscard]] KinematicsResult<std::vector<double>> positions_for(const Vector3d& entry,
                                                                    const Vector3d& target,
                                                                    double rotation_rad) const override {
    return path_length_mm(entry, target)
        .and_then([&](double) { return check_rotation(rotation_rad); })
        .and_then([&] {
          const Vector3d ahead = (target - entry).normalized();
          Pose goal = Pose::Identity();
          goal.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), ahead).toRotationMatrix();
          goal.translation() = target;
          return model_->path.solve(frame_of(goal));
        })
        .map([&](const KDL::JntArray& joints) {
          std::vector<double> positions = listed(joints);
          if (model_->last_turns) {
            positions.back() = rotation_rad;
          }
          return positions;
        });
  }

  [[nodiscard]] KinematicsResult<std::vector<double>> positions_for(
      const Pose& zframe_from_treatment, const std::optional<Vector3d>& entry) const override {
    return check_on_axis(zframe_from_treatment, entry)
        .and_then([&] { return model_->pose.solve(frame_of(zframe_from_treatment)); })
        .map([&](const KDL::JntArray& joints) { return listed(joints); });
  }

  [[nodiscard]] KinematicsResult<RobotBody> zframe_body(std::span<const double> positions) const override {
    return kdl_joints(positions).map([&](const KDL::JntArray& joints) {
      RobotBody body;
      Vector3d end = Vector3d::Zero();
      const auto lead_to = [&](std::string_view name, const Vector3d& next) {
        if (!next.isApprox(end)) {
          body.push_back({name, end, next});
        }
        end = next;
      };
      const auto place = [&](std::size_t segments) -> Vector3d {
        return pose_of(forward(model_->pose.chain(), joints, static_cast<int>(segments))).translation();
      };
      for (std::size_t joint = 0; joint < model_->joints.size(); ++joint) {
        lead_to("arm", place(2 * joint + 1));
        lead_to("slider", place(2 * joint + 2));
      }
      const Pose treatment = pose_of(forward(model_->pose.chain(), joints));
      body.push_back({"probe", end, treatment * Vector3d(0.0, 0.0, probe_.treatment_to_tip_mm)});
      return body;
    });
  }

  [[nodiscard]] std::optional<double> depth_mm(std::span<const double> /*positions*/) const override {
    return std::nullopt;
  }

  /** The frames from the tool to the base. A direction is none of them: its frame turns it. */
  [[nodiscard]] std::vector<CalibratedNumber> calibrated() const override {
    std::vector<std::string> frames{"tool"};
    for (std::size_t joint = model_->joints.size(); joint-- > 0;) {
      frames.push_back("joint[" + std::to_string(joint) + ']');
    }
    std::vector<CalibratedNumber> numbers;
    for (const std::string& frame : frames) {
      for (const char* const place : {"[0]", "[1]", "[2]"}) {
        numbers.push_back({frame + ".xyz_mm" + place, Unit::mm, plausible_mm});
      }
      for (const char* const place : {"[0]", "[1]", "[2]"}) {
        numbers.push_back({frame + ".rpy_rad" + place, Unit::rad, plausible_rad});
      }
    }
    return numbers;
  }

  [[nodiscard]] std::span<const SliderPair> slider_pairs() const noexcept override { return {}; }

 private:
  [[nodiscard]] KinematicsResult<void> check_rotation(double rotation_rad) const {
    const ChainJoint& last = model_->joints.back();
    return model_->last_turns
               ? check_range(last.quantity, rotation_rad, last.lowest, last.highest, Code::out_of_reach)
               : check_range("rotation_rad", rotation_rad, 0.0, 0.0);
  }

  [[nodiscard]] KinematicsResult<KDL::JntArray> kdl_joints(std::span<const double> positions) const {
    KDL::JntArray joints(static_cast<unsigned>(positions.size()));
    for (unsigned index = 0; index < joints.rows(); ++index) {
      const Joint& joint = model_->listed[index];
      const auto checked = check_range(joint.quantity, positions[index], -joint.limit, joint.limit);
      if (!checked) {
        return tl::unexpected(checked.error());
      }
      joints(index) = positions[index] / model_->joints[index].per_unit();
    }
    return joints;
  }

  [[nodiscard]] std::vector<double> listed(const KDL::JntArray& joints) const {
    std::vector<double> positions;
    for (unsigned index = 0; index < model_->joints.size(); ++index) {
      positions.push_back(joints(index) * model_->joints[index].per_unit());
    }
    return positions;
  }

  static Pose pose_of(const KDL::Frame& frame) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.M.data);
    pose.translation() = Vector3d(frame.p.data) * mm_per_m;
    return pose;
  }

  static KDL::Frame frame_of(const Pose& pose) {
    const Eigen::Matrix3d& m = pose.linear();
    const Vector3d p = pose.translation() / mm_per_m;
    return {KDL::Rotation(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)),
            KDL::Vector(p.x(), p.y(), p.z())};
  }

  std::shared_ptr<const Model> model_;
  ProbeOffsets probe_;
};

/** `xyz_mm` and `rpy_rad`. */
KDL::Frame read_frame(TableReader& table) {
  const PointMm xyz = table.point_mm("xyz_mm");
  const std::vector<double> rpy = table.numbers("rpy_rad", 3);
  constexpr double turn = 2.0 * std::numbers::pi;
  if (std::ranges::any_of(rpy, [](double angle) { return std::abs(angle) > turn; })) {
    table.refuse_given("rpy_rad", "an angle is more than a turn", "angles in rad");
  }
  return {KDL::Rotation::RPY(rpy[0], rpy[1], rpy[2]), KDL::Vector(xyz[0], xyz[1], xyz[2]) / mm_per_m};
}

void read_limits(TableReader& table, ChainJoint& joint) {
  const bool slides = joint.unit == Unit::mm;
  const std::string_view key = slides ? "limits_mm" : "limits_rad";
  const double farthest = slides ? 1000.0 : angle_limit_rad;
  const std::vector<double> limits = table.numbers(key, 2);
  if (!(limits[0] < limits[1] && limits[0] >= -farthest && limits[1] <= farthest)) {
    table.refuse_given(key, "these are no limits of a joint",
                       "the lowest position and a higher one, within -1000 and 1000");
  }
  joint.lowest = limits[0] / joint.per_unit();
  joint.highest = limits[1] / joint.per_unit();
}

ChainJoint read_joint(TableReader& table) {
  constexpr std::array<std::pair<std::string_view, Unit>, 2> types{
      {{"revolute", Unit::rad}, {"prismatic", Unit::mm}}};
  ChainJoint joint;
  joint.axis = table.identifier("axis");
  table.rename("kinematics.joint." + joint.axis);
  joint.unit = table.choice("type", types);
  joint.quantity = joint.axis + (joint.unit == Unit::mm ? "_mm" : "_rad");
  joint.before = read_frame(table);
  const std::vector<double> direction = table.numbers("direction", 3);
  const KDL::Vector along(direction[0], direction[1], direction[2]);
  if (std::abs(along.Norm() - 1.0) < 1e-6) {
    joint.direction = along / along.Norm();
  } else {
    table.refuse_given("direction", "it is not of length 1", "a unit vector such as [0, 0, 1]");
  }
  read_limits(table, joint);
  table.refuse_unknown_keys();
  return joint;
}

}  // namespace

KinematicsPtr read_serial_chain(TableReader& table) {
  std::vector<ChainJoint> joints;
  const std::string expected = "one [[kinematics.joint]] for each joint, 1 to 10, from the base to the tool";
  TableReader tool = table.table("tool");
  const KDL::Frame treatment = read_frame(tool);
  tool.refuse_unknown_keys();
  for (TableReader& entry : table.tables("joint", expected)) {
    joints.push_back(read_joint(entry));
    const std::string& axis = joints.back().axis;
    if (std::ranges::count(joints, axis, &ChainJoint::axis) > 1) {
      entry.refuse("axis", '"' + axis + "\" moves another joint already", "each axis once");
    }
    if (Search(chain_of(joints, treatment), joints).is_singular_everywhere()) {
      entry.refuse_given("direction", "the joint moves the tool only as those before it do",
                         "a joint that moves it in a direction of its own");
    }
  }
  if (joints.empty() || joints.size() > most_joints) {
    table.refuse("joint", std::to_string(joints.size()) + " joints are given", expected);
    return nullptr;
  }
  auto model = std::make_shared<const Model>(std::move(joints), treatment);
  if (model->path.is_singular_everywhere()) {
    table.refuse("joint", "the tool turns about its z axis, and not by the last joint alone",
                 "a last joint that turns it about its z axis, or none that does");
  }
  return std::make_shared<const SerialChain>(std::move(model), ProbeOffsets{});
}

}  // namespace interlock
