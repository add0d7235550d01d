---------------------------- MODULE ApplyAxisRows ----------------------------
(* Phase 6: the effect of requests that name an axis. The records hold what it
   may read and nothing else: TLC fails at any other field. *)
EXTENDS Axis, TLC

ASSUME
  \A kind \in AxisKinds, state \in AxisStates : \A phase \in (IF state = "HOMING" THEN Phases \
     {"NONE"} ELSE {"NONE"}), stalled \in (IF state = "FAULTED" THEN BOOLEAN ELSE
     {FALSE}), homed \in BOOLEAN, switch \in BOOLEAN, driven \in 0..1, changed \in
     BOOLEAN, setpoint \in -1..1, target \in -1..1 :
    LET before == [ state |-> state, fault |-> IF stalled THEN "STALL" ELSE IF state = "FAULTED" THEN "DRIFT" ELSE "NONE",
                    fault_now |-> FALSE, homing_phase |-> phase, homed |-> homed, switch_triggered |-> switch,
                    stall_driven_ticks |-> driven, setpoint_changed |-> changed, setpoint_counts |-> setpoint,
                    lease_ticks |-> IF state = "MOVING" THEN 1 ELSE 0, drive |-> 1, position_counts |-> 0,
                    homing_ticks |-> 0, since_homing_mark |-> 0, rest_ticks |-> 0 ]
        a == ApplyAxis([home_timeout_ticks |-> 3], before, [kind |-> kind, target |-> target, drive |-> 2, lease |-> 2])
    IN PrintT(<< kind, state, stalled, phase, homed, switch, driven, changed, setpoint, target, a.state,
                 a.fault # "NONE", a.homing_phase, a.homed, a.stall_driven_ticks,
                 a.setpoint_changed, a.setpoint_counts, a.lease_ticks, a.drive >>)
==============================================================================
