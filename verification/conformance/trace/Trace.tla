--------------------------------- MODULE Trace ---------------------------------
(* Does the model do what the kernel did? Trace is what driver.c printed of a run of
   the real kernel: one tuple a tick, as Told below takes it apart. The model takes
   the same inputs and requests, from its own state, and must come to the same
   verdicts, outputs and state. *)
EXTENDS Kernel, TraceData

VARIABLES step,   \* ticks that are accepted
          kernel, \* the model's own state
          same    \* the latest tick ended as the kernel says

Configuration ==
  [ pedal_channels |-> 2, app_timeout_ticks |-> 8, lease_max_ticks |-> 12, pedal_debounce_ticks |-> 3,
    pedal_disagree_ticks |-> 4, bad_frame_limit |-> 3, overrun_limit |-> 3 ]

Axis0 ==
  [ limit_side |-> "LOWER", min_counts |-> -200, max_counts |-> 200, home_offset_counts |-> -190,
    coast_counts |-> 6, deadband_counts |-> 3, max_drive |-> 100, unhomed_max_drive |-> 10,
    unhomed_travel_counts |-> 40, home_drive |-> 10, home_travel_counts |-> 420, home_backoff_counts |-> 40,
    home_timeout_ticks |-> 400, home_rest_ticks |-> 3, stall_ticks |-> 15, stall_min_counts |-> 4,
    reverse_counts |-> 8, drift_counts |-> 8, settle_ticks |-> 5, max_delta_counts |-> 9, required |-> TRUE ]

K == [x \in {0} |-> Axis0]

Input(told) ==
  [ pedal_no |-> told[1][1], pedal_nc |-> told[1][2], estop_loop |-> told[1][3],
    deadline_missed |-> told[1][4], new_attachment |-> told[1][5], config_pass |-> told[1][6],
    any_valid |-> TRUE, state_damaged |-> FALSE,
    readings |-> [x \in {0} |-> [frame |-> told[1][7], moved |-> told[1][8], switch |-> told[1][9]]],
    requests |-> [i \in 1..Len(told[2]) |->
      LET request == told[2][i]
      IN  [ door |-> request[1], kind |-> request[2], axis |-> request[3], target |-> request[4],
            drive |-> request[5], lease |-> request[6], holder |-> request[7] ]] ]

Verdicts(told) == [i \in 1..Len(told[2]) |-> told[2][i][8]]

SystemAsTold(s) ==
  << s.mode, s.cause, s.causes_seen, s.pedal, s.pedal_armed, s.pedal_pressed_ticks, s.pedal_released_ticks,
     s.pedal_disagree_ticks, s.estop, s.app_age_ticks, s.app_alive, s.holder, s.overruns_in_row,
     s.bus_bad_ticks, s.config_sound >>

AxisAsTold(a) ==
  << a.state, a.fault, a.homed, a.switch_triggered, a.card_valid, a.card_seen, a.bad_frames,
     a.ticks_since_frame, a.position_counts, a.delta_counts, a.setpoint_counts, a.drive, a.lease_ticks,
     a.driven_direction, a.press_travel_counts, a.stall_driven_ticks, a.since_stall_mark,
     a.stall_direction, a.setpoint_changed, a.since_reverse_mark, a.reverse_direction,
     a.since_drift_mark, a.undriven_ticks, a.homing_phase, a.homing_ticks, a.since_homing_mark,
     a.rest_ticks >>

(* What the model says, in the order in which the kernel told it. *)
Answer(after) ==
  << [i \in 1..Len(after.answers) |-> after.answers[i].verdict], SystemAsTold(after.system),
     AxisAsTold(after.axes[0]), <<after.gate[0], after.command[0].direction, after.command[0].drive>> >>

Told(told) == << Verdicts(told), told[3], told[4], told[5] >>

Init ==
  /\ step = 0
  /\ kernel = [system |-> Booted(Configuration, TRUE, 0), axes |-> [x \in {0} |-> BlankAxis]]
  /\ same = TRUE

(* A difference is shown, and ends the run. *)
Next ==
  /\ step < Len(Trace) /\ same
  /\ LET told  == Trace[step + 1]
         after == Tick(Configuration, K, kernel, Input(told))
     IN  /\ same' = (Answer(after) = Told(told))
         /\ ~same' => PrintT(<<"REJECTED", step + 1, "model", Answer(after), "kernel", Told(told)>>)
         /\ kernel' = [system |-> after.system, axes |-> after.axes]
         /\ step' = step + 1

Spec == Init /\ [][Next]_<<step, kernel, same>>

(* TLC looks at each step once: to it, steps alone tell states apart. *)
View == <<step, same>>

Rejected == ~same
Accepted == step = Len(Trace) => ~same \/ PrintT(<<"ACCEPTED", step>>)
================================================================================
