---------------------------- MODULE CausesSeenRows ----------------------------
(* Phase 5: which causes are listed, for every list before. *)
EXTENDS System, TLC

CONSTANTS bad_frame_limit, pedal_disagree_ticks, overrun_limit, pedal_debounce_ticks

Configuration ==
  [ bad_frame_limit |-> bad_frame_limit, pedal_disagree_ticks |-> pedal_disagree_ticks,
    overrun_limit |-> overrun_limit, pedal_debounce_ticks |-> pedal_debounce_ticks ]

ASSUME
  \A mode \in Modes, boot \in BOOLEAN, pulled \in BOOLEAN, silent \in BOOLEAN, split \in BOOLEAN,
     broken \in BOOLEAN, late \in BOOLEAN, damaged \in BOOLEAN, estop \in BOOLEAN,
     bus \in 0..bad_frame_limit, disagree \in 0..(pedal_disagree_ticks + 1), overruns \in 0..overrun_limit :
    LET List(listed) ==
          {cause \in {"BOOT", "ESTOP", "BUS", "PEDAL", "INTEGRITY", "OVERRUN"} : listed[cause]}
        seen == List([BOOT |-> boot, ESTOP |-> pulled, BUS |-> silent, PEDAL |-> split,
                      INTEGRITY |-> broken, OVERRUN |-> late])
        before ==
          [ mode |-> mode, cause |-> "NONE", causes_seen |-> seen, pedal |-> "DISAGREE", pedal_armed |-> FALSE,
            pedal_pressed_ticks |-> 0, pedal_released_ticks |-> 0, app_alive |-> FALSE,
            estop |-> estop, bus_bad_ticks |-> bus, pedal_disagree_ticks |-> disagree,
            overruns_in_row |-> overruns ]
        alarms == [configuration_damaged |-> damaged, new_fault |-> FALSE, required_card_lost |-> FALSE]
        after == ChangeMode(Configuration, before, alarms).causes_seen
    IN PrintT(<< mode, boot, pulled, silent, split, broken, late, damaged, estop, bus, disagree, overruns,
                 "BOOT" \in after, "ESTOP" \in after, "BUS" \in after, "PEDAL" \in after,
                 "INTEGRITY" \in after, "OVERRUN" \in after >>)
===============================================================================
