--------------------------- MODULE GateLimitsRows ----------------------------
(* Phase 7: the gate from the wish on. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

CONSTANTS reach, coast_counts, unhomed_travel_counts, max_drive, unhomed_max_drive

Bounds == [ min_counts |-> -reach, max_counts |-> reach, coast_counts |-> coast_counts,
            unhomed_travel_counts |-> unhomed_travel_counts, max_drive |-> max_drive,
            unhomed_max_drive |-> unhomed_max_drive ]

ASSUME
  \A homing \in BOOLEAN, direction \in {"INCREASING", "DECREASING"}, drive \in 1..3, switch \in
     BOOLEAN, side \in Sides, homed \in BOOLEAN, position \in -reach..reach,
     press \in -3..3 :
    LET s == [mode |-> "MOTION", pedal |-> "PRESSED", estop |-> FALSE]
        a == [ card_valid |-> TRUE, state |-> IF homing THEN "HOMING" ELSE "MOVING", lease_ticks |-> 1,
               switch_triggered |-> switch, homed |-> homed, position_counts |-> position,
               press_travel_counts |-> press ]
        gate == Gate([limit_side |-> side] @@ Bounds, s, a, [direction |-> direction, drive |-> drive])
    IN PrintT(<< homing, direction, drive, switch, side, homed, position, press, gate >>)
==============================================================================
