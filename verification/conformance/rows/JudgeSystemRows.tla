--------------------------- MODULE JudgeSystemRows ---------------------------
(* Phase 6: requests that name no axis. The records hold what it may read and
   nothing else: TLC fails at any other field. *)
EXTENDS System, TLC

ASSUME
  \A kind \in SystemKinds, mode \in Modes, pedal \in PedalStates, estop \in BOOLEAN, bus \in
     0..1, overruns \in 0..1, sound \in BOOLEAN, alive \in BOOLEAN :
    LET s == [ mode |-> mode, pedal |-> pedal, estop |-> estop, bus_bad_ticks |-> bus,
               overruns_in_row |-> overruns, config_sound |-> sound, app_alive |-> alive ]
        verdict == JudgeSystem(s, [kind |-> kind])
    IN PrintT(<< kind, mode, pedal, estop, bus, overruns, sound, alive, verdict >>)
==============================================================================
