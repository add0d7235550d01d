----------------------------- MODULE HomingRows ------------------------------
(* Phase 4: homing. The records hold what it may read and nothing else: TLC
   fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS home_travel_counts, home_backoff_counts, home_rest_ticks, home_offset_counts

Bounds == [ home_travel_counts |-> home_travel_counts, home_backoff_counts |-> home_backoff_counts,
            home_rest_ticks |-> home_rest_ticks, home_offset_counts |-> home_offset_counts ]

ASSUME
  \A state \in AxisStates : \A phase \in (IF state = "HOMING" THEN Phases \ {"NONE"} ELSE
     {"NONE"}), valid \in BOOLEAN, switch \in BOOLEAN, delta \in -1..1, ticks \in 0..2,
     since \in -3..3, rest \in 0..home_rest_ticks, homed \in BOOLEAN, position \in {0,
     home_offset_counts} :
    LET before == [ state |-> state, homing_phase |-> phase, card_valid |-> valid, switch_triggered |-> switch,
                    delta_counts |-> delta, homing_ticks |-> ticks, since_homing_mark |-> since,
                    rest_ticks |-> rest, homed |-> homed, position_counts |-> position ]
        a == AdvanceHoming(Bounds, before)
    IN PrintT(<< state, phase, valid, switch, delta, ticks, since, rest, homed, position =
                 home_offset_counts, a.state, a.homing_phase, a.homing_ticks,
                 a.since_homing_mark, a.rest_ticks, a.homed, a.position_counts =
                 home_offset_counts, JudgeHoming(Bounds, a) >>)
==============================================================================
