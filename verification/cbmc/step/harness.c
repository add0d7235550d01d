/**
 * @file
 * The tick as a whole: its phases in their order, each once and with the right arguments, one verdict a
 * request, and outputs that are nothing but what the gate let through. The phases themselves are proved
 * apart; what is compared here is what the step does besides them.
 */
#include "axis_effects.h"
#include "counts.h"
#include "interlock/kernel.h"
#include "proof.h"
#include "stubs.h"

/** P1: what leaves is the wish where the gate is open, and zero drive everywhere else. */
static void show_outputs(uint32_t slot) {
  const bool open = chosen.gate[slot] == ILK_GATE_OPEN;
  const ilk_command_t* command = &out.command[slot];
  const ilk_command_t* wish = &chosen.wish[slot];
  SHOW(out.gate[slot] == chosen.gate[slot], "P1: the gate is told");
  SHOW((command->direction == (open ? wish->direction : 0u)) &&
           (command->drive == (open ? wish->drive : 0u)) &&
           (command->amplitude == (open ? wish->amplitude : 0u)),
       "P1, P2: zero drive unless the gate is open");
  SHOW(seen.noted_drive[slot] == open, "P5: every driven tick is noted, and no other");
  SHOW(seen.noted_arrival[slot] ==
           ((chosen.gate[slot] == ILK_GATE_SETPOINT) && (left.axis[slot].state == ILK_AXIS_MOVING) &&
            (wish->direction == ILK_DIRECTION_NONE)),
       "P5: an arrival is a move within the deadband of its setpoint");
}

static void show_lamps(void) {
  bool stalled = false;
  bool faulted = false;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    stalled = stalled || (left.axis[slot].fault == ILK_FAULT_STALL);
    faulted = faulted || (left.axis[slot].fault != ILK_FAULT_NONE);
  }
  const bool moves = left.mode == ILK_MODE_MOTION;
  const bool clear = moves || (left.mode == ILK_MODE_READY);
  SHOW(out.lamp[ILK_LAMP_PEDAL] == ((left.estop != 0u) ? ILK_COLOUR_RED
                                    : moves            ? ILK_COLOUR_GREEN
                                                       : ILK_COLOUR_OFF),
       "lamp: pedal");
  SHOW(out.lamp[ILK_LAMP_NETWORK] == ((left.app_alive != 0u) ? ILK_COLOUR_GREEN : ILK_COLOUR_RED),
       "lamp: network");
  SHOW(out.lamp[ILK_LAMP_CONTROLLER] == (clear ? ILK_COLOUR_GREEN : ILK_COLOUR_RED), "lamp: controller");
  SHOW(out.lamp[ILK_LAMP_STALL] == (stalled   ? ILK_COLOUR_PURPLE
                                    : faulted ? ILK_COLOUR_AMBER
                                              : ILK_COLOUR_OFF),
       "lamp: stall");
}

/** Phases 2 to 5 are run unless there is no valid configuration. */
static void show_phases(bool looked) {
  bool any_valid = false;
  uint32_t cards = 0u;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const uint32_t card = config.axis[slot].card;
    const bool holds_card = is_motor_card(card) || (card == ILK_CARD_SENSOR);
    cards = cards | ((looked && holds_card) ? (1u << slot) : 0u);
    any_valid = any_valid || (holds_card && chosen.valid[slot]);
  }
  SHOW(seen.rebuilt == !chosen.sound, "P14: a state that is not sound is rebuilt, and no other");
  SHOW((seen.sliced == looked) && (seen.observed == looked) && (seen.changed == looked),
       "P13: phases 1, 3 and 5 are run, unless there is no valid configuration");
  SHOW((seen.unpacked == (looked ? ILK_SLOTS : 0u)) && (seen.cards == cards), "phase 2 judges every card");
  SHOW(seen.axes == (looked ? ((1u << ILK_SLOTS) - 1u) : 0u), "phase 4 observes every axis");
  SHOW((seen.wished == ILK_SLOTS) && (seen.gated == ILK_SLOTS), "phase 7 asks the gate for every axis");
  SHOW((seen.packed == ILK_SLOTS) && (seen.at == AT_SEAL),
       "phase 8 packs every slot, and a tick ends sealed");
  if (looked) {
    left.bus_bad_ticks = any_valid ? 0u : (uint32_t)one_more(left.bus_bad_ticks, UINT32_MAX);
  }
}

static bool bit_of(uint32_t bits, uint32_t bit) { return ((bits >> bit) & 1u) == 1u; }

/** Lets every phase decide whatever it may: truths from bits, so that each is 0 or 1; codes that are known.
 */
static void choose(void) {
  choice_t any_choice;
  uint32_t flags;
  uint32_t intact;
  uint32_t at_switch;
  uint32_t valid;
  uint32_t lost;
  uint32_t faulted;
  chosen = any_choice;
  chosen.sound = bit_of(flags, 0u);
  chosen.damaged = bit_of(flags, 1u);
  chosen.basis_kept = bit_of(flags, 2u);
  chosen.rebuilt.mode = ILK_MODE_LOCKED;                                   /* proof `soundness` */
  GIVEN((chosen.mode < ILK_MODE_COUNT) && (chosen.mode != ILK_MODE_INIT)); /* proof `mode` */
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    chosen.reading[slot].intact = bit_of(intact, slot);
    chosen.reading[slot].switch_triggered = bit_of(at_switch, slot);
    chosen.valid[slot] = bit_of(valid, slot);
    chosen.lost[slot] = bit_of(lost, slot);
    chosen.faulted[slot] = bit_of(faulted, slot);
    GIVEN(chosen.gate[slot] < ILK_GATE_COUNT);
  }
  GIVEN((chosen.mode_after < ILK_MODE_COUNT) && (chosen.mode_after != ILK_MODE_INIT)); /* proof `requests` */
}

/** Which word of the frames out and which verdict are looked at. */
typedef struct {
  uint32_t slot;
  uint32_t word;
  uint32_t index;
} place_t;

static void show_tick(const place_t* any) {
  const uint32_t mode_before = state.mode;
  const uint32_t word_before = out.frame[any->slot][any->word];
  const uint32_t verdict_before = out.verdict[any->index].verdict;
  const uint32_t count_before = out.verdict_count;
  left = state;
  ilk_step(&config, &state, &in, requests, chosen.count, &out);
  const bool looked = !chosen.sound || (mode_before != ILK_MODE_INIT);
  show_phases(looked);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    show_outputs(slot);
    show_same_axis(&state.axis[slot], &left.axis[slot]);
  }
  show_lamps();
  left.tick = (left.tick == UINT32_MAX) ? 0u : (left.tick + 1u);
  show_same_system(&state, &left);
  SHOW(looked || (state.mode == ILK_MODE_INIT), "P13: INIT is not left by a step");
  SHOW(out.frame[any->slot][any->word] == word_before, "P1: packing alone writes frames");
  SHOW((out.verdict_count == count_before) && (out.verdict[any->index].verdict == verdict_before),
       "P11: phase 6 alone gives verdicts");

  GOAL(goal_driven, looked && (out.command[9].drive > 0u));
  GOAL(goal_arrived, seen.noted_arrival[9]);
  GOAL(goal_init, !looked);
  GOAL(goal_rebuilt, seen.rebuilt && (mode_before == ILK_MODE_INIT));
  GOAL(goal_bus_bad, looked && (state.bus_bad_ticks == 3u));
  GOAL(goal_wraps, state.tick == 0u);
  GOAL(goal_amber, out.lamp[ILK_LAMP_STALL] == ILK_COLOUR_AMBER);
  GOAL(never_driven_through_a_closed_gate, (out.command[9].drive != 0u) && (out.gate[9] != ILK_GATE_OPEN));
  GOAL(never_unsealed, state.seal != chosen.seal);
}

void harness(void) {
  ilk_config_t any_config;
  ilk_state_t any_state;
  ilk_inputs_t any_inputs;
  ilk_outputs_t any_outputs;
  place_t any;
  config = any_config;
  state = any_state;
  in = any_inputs;
  out = any_outputs;
  GIVEN((any.slot < ILK_SLOTS) && (any.word < (uint32_t)ILK_FRAME_WORDS) &&
        (any.index < ILK_REQUESTS_PER_TICK));
  choose();
  show_tick(&any);
}
