----------------------------- MODULE RebuiltRows ------------------------------
(* Phase 1: what stands in place of a damaged state, the system and any one axis,
   and what ilk_init begins with. *)
EXTENDS System, Axis, TLC

CONSTANTS app_timeout_ticks

ASSUME
  \A cause \in Causes \ {"NONE"} :
    LET s == Rebuilt([app_timeout_ticks |-> app_timeout_ticks], cause, 0)
        a == BlankAxis
    IN PrintT(<< cause, s.mode, s.cause, "BOOT" \in s.causes_seen, "ESTOP" \in s.causes_seen,
                 "BUS" \in s.causes_seen, "PEDAL" \in s.causes_seen, "INTEGRITY" \in s.causes_seen,
                 "OVERRUN" \in s.causes_seen, s.pedal, s.pedal_armed, s.pedal_pressed_ticks,
                 s.pedal_released_ticks, s.pedal_disagree_ticks, s.estop, s.app_age_ticks,
                 s.app_alive, s.holder, s.overruns_in_row, s.bus_bad_ticks, s.config_sound,
                 a.state, a.fault, a.homed, a.switch_triggered, a.card_valid, a.card_seen,
                 a.bad_frames, a.ticks_since_frame, a.position_counts, a.delta_counts,
                 a.setpoint_counts, a.drive, a.lease_ticks, a.driven_direction,
                 a.press_travel_counts, a.stall_driven_ticks, a.since_stall_mark,
                 a.stall_direction, a.setpoint_changed, a.since_reverse_mark,
                 a.reverse_direction, a.since_drift_mark, a.undriven_ticks, a.homing_phase,
                 a.homing_ticks, a.since_homing_mark, a.rest_ticks >>)
===============================================================================
