---------------------------- MODULE ChangeModeRows ----------------------------
(* Phase 5 on every state, whatever phases 2 to 4 found. The list of causes seen
   is the table causes_seen. *)
EXTENDS System, TLC

CONSTANTS bad_frame_limit, pedal_disagree_ticks, overrun_limit, pedal_debounce_ticks

Configuration ==
  [ bad_frame_limit |-> bad_frame_limit, pedal_disagree_ticks |-> pedal_disagree_ticks,
    overrun_limit |-> overrun_limit, pedal_debounce_ticks |-> pedal_debounce_ticks ]

(* A cause that is kept is not looked at. *)
Kept == <<"kept">>

ASSUME
  \A mode \in Modes, pedal \in PedalStates, armed \in BOOLEAN,
     pressed \in 0..pedal_debounce_ticks, released \in 0..pedal_debounce_ticks, alive \in BOOLEAN,
     damaged \in BOOLEAN, estop \in BOOLEAN, bus \in 0..bad_frame_limit,
     disagree \in 0..(pedal_disagree_ticks + 1), overruns \in 0..overrun_limit,
     fault \in BOOLEAN, lost \in BOOLEAN :
    LET before ==
          [ mode |-> mode, cause |-> Kept, causes_seen |-> {}, pedal |-> pedal, pedal_armed |-> armed,
            pedal_pressed_ticks |-> pressed, pedal_released_ticks |-> released, app_alive |-> alive,
            estop |-> estop, bus_bad_ticks |-> bus, pedal_disagree_ticks |-> disagree,
            overruns_in_row |-> overruns ]
        alarms == [configuration_damaged |-> damaged, new_fault |-> fault, required_card_lost |-> lost]
        s == ChangeMode(Configuration, before, alarms)
    IN PrintT(<< mode, pedal, armed, pressed, released, alive, damaged, estop, bus, disagree, overruns,
                 fault, lost,
                 s.mode, IF mode = "LOCKED" \/ s.mode # "LOCKED" THEN (IF s.cause = Kept THEN "NONE" ELSE "CHANGED") ELSE s.cause, s.pedal_armed, s.pedal_pressed_ticks, s.pedal_released_ticks >>)
===============================================================================
