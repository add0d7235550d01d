/**
 * @file
 * P4 with a plant: whatever the axis is told, a motor that coasts at most `coast_counts` from the reading on
 * which drive was last allowed never leaves the soft range. By induction over ticks, with the real gate.
 */
#include "counts.h"
#include "gate.h"
#include "proof.h"
#include "valid.h"

/** Where the axis is, and the reading and direction with which drive was last allowed. */
typedef struct {
  int64_t position;
  int64_t allowed_at;
  uint32_t allowed_direction;
} plant_t;

/** How far the motor may have come: only onward, and no farther than it coasts. */
static bool within_reach(const plant_t* plant, int64_t coast) {
  const int64_t gone = directed(plant->allowed_direction, plant->position - plant->allowed_at);
  return between(gone, 0, coast) &&
         ((plant->allowed_direction != ILK_DIRECTION_NONE) || (plant->position == plant->allowed_at));
}

/** The induction: the plant is within reach of where drive was allowed, and all that it can reach is in
 * range. */
static bool is_safe(const ilk_axis_config_t* config, const plant_t* plant) {
  const int64_t coast = config->coast_counts;
  const int64_t farthest = plant->allowed_at + directed(plant->allowed_direction, coast);
  return within_reach(plant, coast) && between(plant->allowed_at, config->min_counts, config->max_counts) &&
         between(farthest, config->min_counts, config->max_counts);
}

void harness(void) {
  ilk_axis_config_t config;
  ilk_state_t state;
  ilk_axis_t axis;
  ilk_command_t wish;
  plant_t plant;
  GIVEN(valid_geometry(&config) && (axis.homed == 1u) && (plant.allowed_direction < ILK_DIRECTION_COUNT));
  GIVEN(between(plant.position, INT32_MIN, INT32_MAX) && between(plant.allowed_at, INT32_MIN, INT32_MAX));

  plant_t resting = {plant.position, plant.position, ILK_DIRECTION_NONE};
  SHOW(IMPLIES(between(plant.position, config.min_counts, config.max_counts), is_safe(&config, &resting)),
       "P4: an axis at rest in its range is safe");

  GIVEN(is_safe(&config, &plant) && (axis.position_counts == plant.position));
  const plant_t before = plant;
  const ilk_gate_t gate = ilk_output_gate(&config, &state, &axis, &wish);
  if (gate == ILK_GATE_OPEN) {
    plant.allowed_at = plant.position;
    plant.allowed_direction = wish.direction;
  }
  int64_t next;
  GIVEN(between(next, INT32_MIN, INT32_MAX));
  plant.position = next;
  GIVEN(within_reach(&plant, config.coast_counts));
  SHOW(between(plant.position, config.min_counts, config.max_counts),
       "P4: the position never leaves the soft range");
  SHOW(is_safe(&config, &plant), "P4: and stays safe");

  GOAL(goal_driven_to_the_limit, (gate == ILK_GATE_OPEN) &&
                                     (plant.position == (int64_t)config.max_counts - 1) &&
                                     (config.coast_counts > 5u));
  GOAL(goal_coasts_on, (gate != ILK_GATE_OPEN) && (plant.position > before.position));
  GOAL(goal_turns_back, (gate == ILK_GATE_OPEN) && (before.allowed_direction == ILK_DIRECTION_INCREASING) &&
                            (wish.direction == ILK_DIRECTION_DECREASING));
  GOAL(never_beyond_the_limit, plant.position > (int64_t)config.max_counts);
}
