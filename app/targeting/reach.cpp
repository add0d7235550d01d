#include "targeting/reach.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

namespace interlock {
namespace {

/** Any number, the same each time. */
constexpr std::uint64_t reach_seed = 1;

using Cell = Eigen::Vector3i;

/** Cells have indices from 0 to `reach_cells_a_side`. */
std::int64_t key_of(const Cell& cell) {
  constexpr std::int64_t base = reach_cells_a_side + 3;
  return ((cell.x() + 1) * base + cell.y() + 1) * base + cell.z() + 1;
}

class Grid {
 public:
  Grid(const Workspace& points, double cell_mm) : lowest_(points.bounds.min()), cell_mm_(cell_mm) {
    for (const Eigen::Vector3d& point : points.zframe_mm) {
      const Cell cell = ((point - lowest_) / cell_mm_).array().floor().cast<int>();
      if (taken_.insert(key_of(cell)).second) {
        cells_.push_back(cell);
      }
    }
  }

  [[nodiscard]] std::size_t size() const { return cells_.size(); }

  [[nodiscard]] std::vector<Eigen::Vector3d> shell() const {
    std::vector<Eigen::Vector3d> centres;
    for (const Cell& cell : cells_) {
      if (!is_within(cell)) {
        centres.emplace_back(lowest_ + (cell.cast<double>() + Eigen::Vector3d::Constant(0.5)) * cell_mm_);
      }
    }
    return centres;
  }

 private:
  [[nodiscard]] bool is_within(const Cell& cell) const {
    for (int axis = 0; axis < 3; ++axis) {
      const Cell step = Cell::Unit(axis);
      if (!taken_.contains(key_of(cell + step)) || !taken_.contains(key_of(cell - step))) {
        return false;
      }
    }
    return true;
  }

  Eigen::Vector3d lowest_;
  double cell_mm_;
  std::unordered_set<std::int64_t> taken_;
  std::vector<Cell> cells_;
};

}  // namespace

KinematicsResult<Reach> reach_of(const Robot& robot, const RobotKinematics& kinematics, std::size_t draws) {
  AxisPositions lowest;
  AxisPositions highest;
  for (const Axis& axis : robot.axes) {
    const double ends[] = {axis.to_unit(axis.lowest_setpoint_counts()),
                           axis.to_unit(axis.highest_setpoint_counts())};
    lowest.push_back(std::min(ends[0], ends[1]));
    highest.push_back(std::max(ends[0], ends[1]));
  }
  return kinematics.workspace(lowest, highest, draws, reach_seed).map([&](const Workspace& points) {
    Reach reach{0.0, {}, 0, draws, points.refused};
    if (!points.zframe_mm.empty()) {
      const double longest = points.bounds.sizes().maxCoeff();
      reach.cell_mm = std::max(1.0, longest / reach_cells_a_side);
      const Grid grid(points, reach.cell_mm);
      reach.cells = grid.size();
      reach.shell_mm = grid.shell();
    }
    return reach;
  });
}

}  // namespace interlock
