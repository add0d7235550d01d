#include "calibration/calibration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <unsupported/Eigen/NonLinearOptimization>

#include "calibration/calibration_model.hpp"
#include "robot/robot_text.hpp"
#include "robot/table_reader.hpp"

namespace interlock {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/** A fitted number has at most this deviation, of its plausible error. */
constexpr double largest_deviation = 0.5;
/** Of the frame: a turn about the centre of the points in 0.01 rad, a shift in mm. */
constexpr Index frame_size = 6;
constexpr double frame_turn_rad = 0.01;
constexpr double largest_frame_deviation = 10.0;
/** Misses beyond this come from wrong units, signs or joints. */
constexpr double farthest_rms_mm = 20.0;
/** Of a number's plausible error, for differences. */
constexpr double difference = 1e-3;
/** Misses of a pose that cannot be, in standard deviations: more than those of any that can. */
constexpr double impossible = 1e12;
/** Farther than so many plausible errors no number of a robot is from its file. */
constexpr double farthest_change = 5.0;
constexpr int most_rounds = 10;
constexpr double lever_mm = 100.0;

/** The fit while it goes on. The unknowns x: those of the frame, then the kept numbers, in plausible errors.
 */
class Fit {
 public:
  Fit(const CalibrationModel& model, const std::vector<MeasuredPose>& poses,
      const CalibrationOptions& options)
      : model_(model),
        poses_(poses),
        frame_(options.in_zframe ? 0 : frame_size),
        directed_(poses.front().direction.has_value()),
        changes_(model.numbers().size(), 0.0) {
    for (const MeasuredPose& pose : poses) {
      sd_mm_.push_back(pose.sd_mm.value_or(options.sd_mm.value_or(0.0)));
      sd_rad_.push_back(pose.sd_rad.value_or(options.sd_rad.value_or(0.0)));
      centre_ += pose.point_mm / static_cast<double>(poses.size());
    }
    states_mm_ = sd_mm_.front() > 0.0;
    states_rad_ = sd_rad_.front() > 0.0;
  }

  [[nodiscard]] Index rows() const { return (directed_ ? 6 : 3) * static_cast<Index>(poses_.size()); }
  /** Numbers that were measured: a direction has two. */
  [[nodiscard]] std::size_t equations() const { return (directed_ ? 5 : 3) * poses_.size(); }
  [[nodiscard]] std::size_t unknowns() const { return static_cast<std::size_t>(frame_) + kept_.size(); }
  [[nodiscard]] std::size_t freedom() const { return equations() - unknowns(); }
  [[nodiscard]] bool directed() const { return directed_; }
  [[nodiscard]] Index frame_columns() const { return frame_; }
  [[nodiscard]] const Pose& frame() const { return tracker_from_zframe_; }
  [[nodiscard]] const std::vector<std::size_t>& kept() const { return kept_; }
  [[nodiscard]] double change(std::size_t number) const { return changes_[number]; }
  [[nodiscard]] double sd_mm(std::size_t pose) const { return sd_mm_[pose]; }
  [[nodiscard]] bool states_mm() const { return states_mm_; }

  /** The frame in which points, and points ahead of them, lie best (S. Umeyama, 1991). False when they lie
   * far better in a frame that no turn leads to: then they are a mirror image. */
  [[nodiscard]] bool place_frame() {
    const std::vector<Pose> tools = *model_.poses(changes_, poses_);
    const auto count = static_cast<Index>(poses_.size());
    Eigen::Matrix3Xd from(3, directed_ ? 2 * count : count);
    Eigen::Matrix3Xd to = from;
    for (Index place = 0; place < count; ++place) {
      const MeasuredPose& pose = poses_[static_cast<std::size_t>(place)];
      const Pose& tool = tools[static_cast<std::size_t>(place)];
      from.col(place) = tool.translation();
      to.col(place) = pose.point_mm;
      if (directed_) {
        from.col(count + place) = tool.translation() + lever_mm * tool.linear().col(2);
        to.col(count + place) = pose.point_mm + lever_mm * *pose.direction;
      }
    }
    if (frame_ == 0) {
      return true;
    }
    tracker_from_zframe_.matrix() = Eigen::umeyama(from, to, false);
    const auto misses_of = [&](const Eigen::Matrix3Xd& seen) {
      const Pose best(Eigen::Matrix4d(Eigen::umeyama(from, seen, false)));
      return (best * from - seen).squaredNorm();
    };
    constexpr double far_better = 0.25;
    const double as_seen = misses_of(to);
    to.row(0) *= -1.0;
    return misses_of(to) > far_better * as_seen;
  }

  /** Misses of points in mm and of directions, six or three rows a pose; empty when a pose cannot be. */
  [[nodiscard]] std::optional<VectorXd> misses(const VectorXd& x, std::span<const std::size_t> moved) const {
    std::vector<double> changes = changes_;
    for (std::size_t place = 0; place < moved.size(); ++place) {
      changes[moved[place]] += x[frame_ + static_cast<Index>(place)] * plausible(moved[place]);
    }
    const auto tools = model_.poses(changes, poses_);
    if (!tools) {
      return std::nullopt;
    }
    const Pose frame = moved_frame(x);
    VectorXd rows(this->rows());
    Index row = 0;
    for (std::size_t place = 0; place < poses_.size(); ++place) {
      const Pose tool = frame * (*tools)[place];
      rows.segment<3>(row) = tool.translation() - poses_[place].point_mm;
      row += 3;
      if (directed_) {
        rows.segment<3>(row) = tool.linear().col(2) - *poses_[place].direction;
        row += 3;
      }
    }
    return rows;
  }

  /** The misses as they are. */
  [[nodiscard]] VectorXd misses() const { return *misses(VectorXd::Zero(frame_), {}); }

  /** In standard deviations. */
  [[nodiscard]] VectorXd normalised(VectorXd rows) const {
    const Index size = directed_ ? 6 : 3;
    for (std::size_t place = 0; place < poses_.size(); ++place) {
      rows.segment<3>(static_cast<Index>(place) * size) /= sd_mm_[place];
      if (directed_) {
        rows.segment<3>(static_cast<Index>(place) * size + 3) /= sd_rad_[place];
      }
    }
    return rows;
  }

  /** By the unknowns, in standard deviations. */
  [[nodiscard]] MatrixXd jacobian(const VectorXd& x, std::span<const std::size_t> moved) const {
    MatrixXd columns(rows(), x.size());
    for (Index place = 0; place < x.size(); ++place) {
      VectorXd ahead = x;
      VectorXd behind = x;
      ahead[place] += difference;
      behind[place] -= difference;
      // At the end of what the kinematics allow, from the side that is left.
      const auto up = misses(ahead, moved);
      const auto down = misses(behind, moved);
      const double way = (up ? difference : 0.0) + (down ? difference : 0.0);
      columns.col(place) =
          way > 0.0 ? normalised((up ? *up : *misses(x, moved)) - (down ? *down : *misses(x, moved))) / way
                    : VectorXd(VectorXd::Zero(rows()));
    }
    return columns;
  }

  [[nodiscard]] MatrixXd jacobian(std::span<const std::size_t> moved) const {
    return jacobian(VectorXd::Zero(frame_ + static_cast<Index>(moved.size())), moved);
  }

  /** Deviations that nobody states, from the misses as they are. */
  void estimate_deviations() {
    const VectorXd rows = misses();
    const double shrunk = static_cast<double>(freedom()) / static_cast<double>(equations());
    const auto count = static_cast<double>(poses_.size());
    constexpr double least = 1e-9;
    if (!states_mm_) {
      std::ranges::fill(sd_mm_, std::max(least, std::sqrt(squares(rows, 0) / (3.0 * count * shrunk))));
    }
    if (directed_ && !states_rad_) {
      std::ranges::fill(sd_rad_, std::max(least, std::sqrt(squares(rows, 3) / (2.0 * count * shrunk))));
    }
  }

  /** Sum of squared misses of points (0) or directions (3). */
  [[nodiscard]] double squares(const VectorXd& rows, Index part) const {
    double sum = 0.0;
    for (Index row = part; row < rows.size(); row += directed_ ? 6 : 3) {
      sum += rows.segment<3>(row).squaredNorm();
    }
    return sum;
  }

  /** Finds frame and these numbers, from where they are; every other number is the file's. */
  void solve(std::vector<std::size_t> kept);

 private:
  [[nodiscard]] double plausible(std::size_t number) const { return model_.numbers()[number].plausible; }

  [[nodiscard]] Pose moved_frame(const VectorXd& x) const {
    if (frame_ == 0) {
      return tracker_from_zframe_;
    }
    const Vector3d turn = x.head<3>() * frame_turn_rad;
    const double angle = turn.norm();
    const Vector3d axis = angle > 0.0 ? Vector3d(turn / angle) : Vector3d::UnitX();
    return Pose(Eigen::Translation3d(centre_ + x.segment<3>(3))) * Pose(Eigen::AngleAxisd(angle, axis)) *
           Pose(Eigen::Translation3d(-centre_)) * tracker_from_zframe_;
  }

  const CalibrationModel& model_;
  const std::vector<MeasuredPose>& poses_;
  Index frame_;
  bool directed_;
  bool states_mm_ = false;
  bool states_rad_ = false;
  std::vector<double> sd_mm_;
  std::vector<double> sd_rad_;
  Vector3d centre_ = Vector3d::Zero();
  Pose tracker_from_zframe_ = Pose::Identity();
  std::vector<double> changes_; /**< mm or rad */
  std::vector<std::size_t> kept_;
};

/** As Eigen's Levenberg-Marquardt takes it. */
struct Misses {
  const Fit& fit;
  std::span<const std::size_t> moved;
  Index count;

  [[nodiscard]] int inputs() const { return static_cast<int>(count); }
  [[nodiscard]] int values() const { return static_cast<int>(fit.rows()); }
  int operator()(const VectorXd& x, VectorXd& rows) const {
    const auto misses = fit.misses(x, moved);
    rows = misses ? fit.normalised(*misses) : VectorXd::Constant(fit.rows(), impossible);
    return 0;
  }
  int df(const VectorXd& x, MatrixXd& columns) const {
    columns = fit.jacobian(x, moved);
    return 0;
  }
};

void Fit::solve(std::vector<std::size_t> kept) {
  for (std::size_t number = 0; number < changes_.size(); ++number) {
    if (std::ranges::find(kept, number) == kept.end()) {
      changes_[number] = 0.0;
    }
  }
  kept_ = std::move(kept);
  VectorXd x = VectorXd::Zero(frame_ + static_cast<Index>(kept_.size()));
  if (x.size() == 0) {
    return;
  }
  Misses problem{*this, kept_, x.size()};
  Eigen::LevenbergMarquardt<Misses> search(problem);
  search.parameters.ftol = 1e-14;
  search.parameters.xtol = 1e-12;
  search.parameters.maxfev = 200;
  search.minimize(x);
  tracker_from_zframe_ = moved_frame(x);
  for (std::size_t place = 0; place < kept_.size(); ++place) {
    changes_[kept_[place]] += x[frame_ + static_cast<Index>(place)] * plausible(kept_[place]);
  }
}

/** Inverse of the chosen part of a normal matrix; empty when it has none. */
std::optional<MatrixXd> covariance_of(const MatrixXd& normal, const std::vector<Index>& chosen) {
  const Eigen::LLT<MatrixXd> factor(normal(chosen, chosen));
  const auto size = static_cast<Index>(chosen.size());
  if (factor.info() != Eigen::Success || (size > 0 && factor.rcond() < 1e-14)) {
    return std::nullopt;
  }
  return factor.solve(MatrixXd::Identity(size, size));
}

/** Which numbers the poses determine, and why not the others. */
struct Choice {
  bool frame_is_fixed = true;
  std::vector<std::size_t> kept;
  std::vector<HeldNumber> held;
};

Choice choose(const Fit& fit, const CalibrationModel& model, const std::vector<std::size_t>& candidates) {
  const MatrixXd columns = fit.jacobian(candidates);
  const MatrixXd normal = columns.transpose() * columns;
  const Index frame = fit.frame_columns();
  Choice choice;
  std::vector<Index> chosen(static_cast<std::size_t>(frame));
  std::iota(chosen.begin(), chosen.end(), 0);
  const auto of_frame = covariance_of(normal, chosen);
  choice.frame_is_fixed =
      frame == 0 || (of_frame && std::sqrt(of_frame->diagonal().maxCoeff()) <= largest_frame_deviation);
  for (std::size_t place = 0; place < candidates.size(); ++place) {
    const Index column = frame + static_cast<Index>(place);
    const FileNumber& number = model.numbers()[candidates[place]];
    std::vector<Index> with = chosen;
    with.push_back(column);
    const auto covariance = covariance_of(normal, with);
    if (covariance &&
        std::sqrt(covariance->diagonal().tail(static_cast<Index>(with.size()) - frame).maxCoeff()) <=
            largest_deviation) {
      chosen = std::move(with);
      choice.kept.push_back(candidates[place]);
      continue;
    }
    const double alone = 1.0 / std::sqrt(std::max(normal(column, column), 1e-12));
    std::string why;
    if (alone > largest_deviation) {
      why = "hardly moves the measured poses";
    } else {
      const VectorXd share = normal(chosen, chosen).ldlt().solve(normal(chosen, std::vector{column})).col(0);
      constexpr double large = 0.3;
      bool frame_shares = false;
      for (std::size_t other = 0; other < chosen.size(); ++other) {
        const Index at = chosen[other];
        const bool shares = std::abs(share[static_cast<Index>(other)]) * std::sqrt(normal(at, at)) >
                            large * std::sqrt(normal(column, column));
        if (at < frame) {
          frame_shares |= shares;
        } else if (shares) {
          why += (why.empty() ? "" : ", ") +
                 model.numbers()[candidates[static_cast<std::size_t>(at - frame)]].name();
        }
      }
      if (frame_shares) {
        why += std::string(why.empty() ? "" : ", ") + "the frame in which they were measured";
      }
      why = "moves the measured poses nearly as others do: " + why;
    }
    choice.held.push_back({number.name(), why});
  }
  return choice;
}

/** Every pose with every number wrong by its plausible error either way; a number that the file cannot have
 * so is held. */
tl::expected<void, RobotError> check_surroundings(const CalibrationModel& model,
                                                  const std::vector<MeasuredPose>& poses,
                                                  const std::string& table,
                                                  std::vector<std::size_t>& candidates,
                                                  std::vector<HeldNumber>& held) {
  std::vector<double> changes(model.numbers().size(), 0.0);
  const auto refused = [&](const std::pair<std::uint32_t, std::string>& error, const std::string& when) {
    return tl::unexpected(RobotError{table, error.first, "", error.second + when,
                                     "a pose of the robot, away from the ends of its linkage"});
  };
  if (const auto as_is = model.poses(changes, poses); !as_is) {
    return refused(as_is.error(), "");
  }
  const std::vector<std::size_t> all = candidates;
  for (const std::size_t place : all) {
    const FileNumber& number = model.numbers()[place];
    for (const double change : {number.plausible, -number.plausible}) {
      changes[place] = change;
      const auto moved = model.poses(changes, poses);
      if (!moved && moved.error().first != 0) {
        return refused(moved.error(), " when " + number.name() + " is wrong by " +
                                          text_of(change * number.per_unit) + ' ' + number.unit);
      }
      if (!moved && std::erase(candidates, place) > 0) {
        held.push_back({number.name(), "the file cannot have it otherwise: " + moved.error().second});
      }
    }
    changes[place] = 0.0;
  }
  return {};
}

std::vector<PoseMiss> judged(const Fit& fit, const MatrixXd& columns, const MatrixXd& covariance,
                             const VectorXd& rows, const std::vector<MeasuredPose>& poses) {
  const Index size = fit.directed() ? 6 : 3;
  const double measured = fit.directed() ? 5.0 : 3.0;
  const VectorXd normalised = fit.normalised(rows);
  std::vector<PoseMiss> misses;
  std::vector<double> squares;
  for (std::size_t place = 0; place < poses.size(); ++place) {
    const Index row = static_cast<Index>(place) * size;
    const MatrixXd own = columns.middleRows(row, size);
    const double leverage =
        columns.cols() == 0 ? 0.0 : (own * covariance * own.transpose()).trace() / measured;
    squares.push_back(normalised.segment(row, size).squaredNorm() / std::max(0.05, 1.0 - leverage));
    misses.push_back({poses[place].line, rows.segment<3>(row).norm()});
  }
  std::vector<double> sorted = squares;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const boost::math::chi_squared usual(measured);
  const double unit = std::max(sorted[sorted.size() / 2] / boost::math::median(usual), 1e-18);
  constexpr double once_in = 1e-5;
  for (std::size_t place = 0; place < misses.size(); ++place) {
    misses[place].normalised = std::sqrt(squares[place] / unit / measured);
    misses[place].outlier =
        squares[place] / unit > boost::math::quantile(boost::math::complement(usual, once_in));
  }
  std::ranges::sort(misses, std::greater{}, &PoseMiss::normalised);
  return misses;
}

/** Mean variance of the point along a coordinate, mm², that the unknowns leave. */
double mean_variance_mm2(const Fit& fit, const MatrixXd& columns, const MatrixXd& covariance,
                         std::size_t poses) {
  if (columns.cols() == 0) {
    return 0.0;
  }
  double sum = 0.0;
  for (std::size_t place = 0; place < poses; ++place) {
    const MatrixXd own =
        fit.sd_mm(place) * columns.middleRows(static_cast<Index>(place) * (fit.directed() ? 6 : 3), 3);
    sum += (own * covariance * own.transpose()).trace() / 3.0;
  }
  return sum / static_cast<double>(poses);
}

/** An axis that goes through less of its range than this leaves a gap. */
constexpr double least_range = 0.25;
/** Of the correlations' smallest eigenvalue, which is 1 when every axis moves for itself and 0 when one
 * follows from the others: along one direction the poses then go a fifth as far as their axes do. */
constexpr double least_independence = 0.04;

std::vector<std::string> gaps_of(const Robot& robot, const std::vector<std::size_t>& axes,
                                 const std::vector<MeasuredPose>& poses) {
  std::vector<std::string> gaps;
  MatrixXd moves(static_cast<Index>(poses.size()), static_cast<Index>(axes.size()));
  std::vector<Index> moved;
  for (std::size_t joint = 0; joint < axes.size(); ++joint) {
    const auto column = static_cast<Index>(joint);
    for (std::size_t row = 0; row < poses.size(); ++row) {
      moves(static_cast<Index>(row), column) = poses[row].positions[axes[joint]];
    }
    const Axis& axis = robot.axes[axes[joint]];
    const double range =
        std::abs(axis.to_unit(axis.soft_limits.max_counts) - axis.to_unit(axis.soft_limits.min_counts));
    const double gone = moves.col(column).maxCoeff() - moves.col(column).minCoeff();
    if (gone < least_range * range) {
      gaps.push_back('"' + axis.name + "\" goes through " +
                     std::to_string(std::lround(100.0 * gone / range)) + " % of its range");
    }
    if (gone > 0.0) {
      moves.col(column).array() -= moves.col(column).mean();
      moves.col(column).normalize();
      moved.push_back(column);
    }
  }
  const MatrixXd together = moves(Eigen::all, moved);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> directions(together.transpose() * together);
  if (!moved.empty() && directions.eigenvalues()[0] < least_independence) {
    std::string names;
    for (std::size_t place = 0; place < moved.size(); ++place) {
      constexpr double share = 0.1;
      const double part = directions.eigenvectors()(static_cast<Index>(place), 0);
      if (part * part > share) {
        names +=
            (names.empty() ? "\"" : "\", \"") + robot.axes[axes[static_cast<std::size_t>(moved[place])]].name;
      }
    }
    gaps.push_back("the positions of " + names + "\" follow from one another");
  }
  return gaps;
}

/** To six digits, as the file is written. */
double six_digits(double value) { return std::stod(text_of(value)); }

tl::expected<std::string, RobotError> changed_file(const Robot& robot, std::string_view text,
                                                   const CalibrationModel& model, const Calibration& found) {
  std::vector<AxisNumber> file{{"kinematics.calibration_mm", found.calibration_mm, "kinematics.family"}};
  std::vector<std::pair<std::string, std::vector<AxisNumber>>> tables;
  for (const FittedNumber& fitted : found.fitted) {
    const FileNumber& number = *std::ranges::find(model.numbers(), fitted.name, &FileNumber::name);
    if (number.axis.empty()) {
      file.push_back({fitted.name, fitted.is});
      continue;
    }
    const Axis& axis = robot.axes[number.place];
    const double shift = std::round(fitted.is - fitted.was);
    tables.push_back({axis.name,
                      {{"home_offset_counts", fitted.is},
                       {"soft_limits.min_counts", axis.soft_limits.min_counts + shift},
                       {"soft_limits.max_counts", axis.soft_limits.max_counts + shift}}});
    const auto move = [&](const std::string& key, const std::vector<AxisCounts>& positions) {
      const auto own = std::ranges::find(positions, axis.slot, &AxisCounts::slot);
      if (own != positions.end()) {
        file.push_back({key + '.' + axis.name, own->counts + shift});
      }
    };
    for (std::size_t step = 0; step < robot.home_steps.size(); ++step) {
      move("home_step[" + std::to_string(step) + "].move", robot.home_steps[step].move);
    }
    move("draping", robot.draping);
  }
  tables.push_back({"", std::move(file)});
  tl::expected<std::string, RobotError> changed{std::string(text)};
  for (const auto& [axis, numbers] : tables) {
    changed = changed.and_then(
        [&](const std::string& so_far) { return with_numbers(so_far, robot.origin.file, axis, numbers); });
  }
  return changed;
}

}  // namespace

tl::expected<Calibration, RobotError> calibrate(const Robot& robot, std::string_view text,
                                                const std::vector<MeasuredPose>& poses,
                                                const std::string& table, const CalibrationOptions& options) {
  const auto refused = [](std::string file, std::string problem, std::string expected) {
    return tl::unexpected(RobotError{std::move(file), 0, "", std::move(problem), std::move(expected)});
  };
  if (!robot.kinematics) {
    return refused(robot.origin.file, "the robot has no kinematics", "a robot whose file has [kinematics]");
  }
  if (poses.empty()) {
    return refused(table, "no pose is left", "poses spread over the workspace");
  }
  const CalibrationModel model(robot, text);
  std::vector<std::size_t> candidates;
  Calibration found;
  for (std::size_t place = 0; place < model.numbers().size(); ++place) {
    const std::string name = model.numbers()[place].name();
    if (std::ranges::find(options.hold, name) == options.hold.end()) {
      candidates.push_back(place);
    } else {
      found.held.push_back({name, "held as asked for"});
    }
  }
  for (const std::string& name : options.hold) {
    if (std::ranges::find(model.numbers(), name, &FileNumber::name) == model.numbers().end()) {
      std::string names;
      for (const FileNumber& number : model.numbers()) {
        names += (names.empty() ? "" : ", ") + number.name();
      }
      return refused(robot.origin.file, '"' + name + "\" is not fitted", "one of " + names);
    }
  }
  if (const auto checked = check_surroundings(model, poses, table, candidates, found.held); !checked) {
    return tl::unexpected(checked.error());
  }
  if (const auto problem = deviation_problem(options.sd_mm, options.sd_rad)) {
    return refused(table, *problem, "the tracker's own deviation, or none");
  }
  Fit fit(model, poses, options);
  const std::size_t unknowns = candidates.size() + static_cast<std::size_t>(fit.frame_columns());
  const std::size_t a_pose = fit.directed() ? 5 : 3;
  const std::size_t needed = std::max<std::size_t>(3, (2 * unknowns + a_pose - 1) / a_pose);
  if (poses.size() < needed) {
    return refused(
        table,
        std::to_string(poses.size()) + " poses are given for " + std::to_string(unknowns) + " unknowns",
        std::to_string(needed) + " poses at least, spread over the workspace");
  }
  if (!fit.place_frame()) {
    return refused(table, "the measured points are a mirror image of those that the robot's file gives",
                   "right-handed coordinates: x, y and z of the tracker in their order, with their signs");
  }
  const auto rms_mm = [&] {
    return std::sqrt(fit.squares(fit.misses(), 0) / static_cast<double>(poses.size()));
  };
  const auto rms_rad = [&] {
    return fit.directed()
               ? std::optional(std::sqrt(fit.squares(fit.misses(), 3) / static_cast<double>(poses.size())))
               : std::nullopt;
  };
  if (rms_mm() > farthest_rms_mm || rms_rad().value_or(0.0) > 0.5) {
    return refused(table,
                   "the measured poses are " + text_of(rms_mm()) + " mm" +
                       (fit.directed() ? " and " + text_of(*rms_rad()) + " rad" : "") +
                       " (root mean square) from those that the robot's file gives",
                   "20 mm and 0.5 rad at most: check units (mm, rad), signs, the order of the axes, the "
                   "frame, the probe, and "
                   "that a direction is the way in which the probe advances");
  }
  fit.estimate_deviations();
  Choice choice;
  double last_sd_mm = 0.0;
  for (int round = 0; round < most_rounds; ++round) {
    const bool first = round == 0;
    if (!first) {
      choice = choose(fit, model, candidates);
      if (!choice.frame_is_fixed) {
        return refused(table, "the measured poses do not fix the frame in which they were measured",
                       "points that lie on no line, and more than a few millimetres apart");
      }
      if (round > 1 && choice.kept == fit.kept() && std::abs(last_sd_mm / fit.sd_mm(0) - 1.0) < 0.01) {
        break;
      }
    }
    last_sd_mm = fit.sd_mm(0);
    fit.solve(choice.kept);
    if (first) {
      found.was_rms_mm = rms_mm();
      found.was_rms_rad = rms_rad();
    }
    fit.estimate_deviations();
  }
  std::ranges::copy(choice.held, std::back_inserter(found.held));
  const VectorXd rows = fit.misses();
  const MatrixXd columns = fit.jacobian(fit.kept());
  const MatrixXd normal = columns.transpose() * columns;
  std::vector<Index> all(static_cast<std::size_t>(columns.cols()));
  std::iota(all.begin(), all.end(), 0);
  const double chi_square = fit.normalised(rows).squaredNorm() / static_cast<double>(fit.freedom());
  for (const std::size_t number : fit.kept()) {
    const FileNumber& moved = model.numbers()[number];
    if (std::abs(fit.change(number)) > farthest_change * moved.plausible) {
      return refused(table,
                     moved.name() + " would have to be wrong by " +
                         text_of(fit.change(number) * moved.per_unit) + ' ' + moved.unit,
                     "five times " + text_of(moved.plausible * std::abs(moved.per_unit)) + ' ' + moved.unit +
                         " at most: check how the poses were measured, and the robot's file");
    }
  }
  const auto freedom = static_cast<double>(fit.freedom());
  constexpr double once_in = 1e-4;
  if (chi_square * freedom < boost::math::quantile(boost::math::chi_squared(freedom), once_in)) {
    return refused(
        table,
        "the poses fit " + text_of(std::sqrt(chi_square)) + " times as far as the stated deviation says",
        "the deviation that the tracker has, or none: then it is estimated");
  }
  const auto known = covariance_of(normal, all);
  if (!known) {
    return refused(
        table, "the fit ends where the kinematics end: the poses do not show how well it is known",
        "numbers of the file that are nearer to the robot's, or the ones at the end held (--hold)");
  }
  const MatrixXd covariance = *known * std::max(1.0, chi_square);
  const boost::math::students_t student(static_cast<double>(fit.freedom()));
  for (std::size_t place = 0; place < fit.kept().size(); ++place) {
    const FileNumber& number = model.numbers()[fit.kept()[place]];
    const Index at = fit.frame_columns() + static_cast<Index>(place);
    const double sd = std::sqrt(covariance(at, at)) * number.plausible * std::abs(number.per_unit);
    const double is = number.was + fit.change(fit.kept()[place]) * number.per_unit;
    found.fitted.push_back(
        {number.name(), number.unit, number.was, is, sd, sd * boost::math::quantile(student, 0.975)});
  }
  found.gaps = gaps_of(robot, model.axes(), poses);
  found.misses = judged(fit, columns, covariance, rows, poses);
  found.tracker_from_zframe = fit.frame();
  found.is_rms_mm = rms_mm();
  found.is_rms_rad = rms_rad();
  found.degrees_of_freedom = fit.freedom();
  const double shrunk = static_cast<double>(fit.freedom()) / static_cast<double>(fit.equations());
  const double point_mm2 = fit.squares(rows, 0) / (3.0 * static_cast<double>(poses.size()) * shrunk);
  double tracker_mm2 = 0.0;
  for (std::size_t place = 0; fit.states_mm() && place < poses.size(); ++place) {
    tracker_mm2 += fit.sd_mm(place) * fit.sd_mm(place) / static_cast<double>(poses.size());
  }
  found.point_sd_mm = std::sqrt(point_mm2);
  constexpr double written_mm = 1e-3;
  found.calibration_mm =
      six_digits(std::ceil(std::sqrt(std::max(0.0, point_mm2 - tracker_mm2) +
                                     mean_variance_mm2(fit, columns, covariance, poses.size())) /
                           written_mm) *
                 written_mm);
  return changed_file(robot, text, model, found).map([&](const std::string& changed) {
    found.changed_file = changed;
    return found;
  });
}

}  // namespace interlock
