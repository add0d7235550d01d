--------------------------------- MODULE Trace ---------------------------------
(* Does the model do what the kernel did? TraceData is what told.c printed of a run
   of the real kernel: its configuration, the state that it began with, and one tuple
   a tick, as Told below takes it apart. The model takes the same inputs and requests,
   from its own state, and must come to the same verdicts, outputs and state. *)
EXTENDS Kernel, TraceData

VARIABLES step,   \* ticks that are accepted
          kernel, \* the model's own state
          same    \* the latest tick ended as the kernel says

(* The axes, and the place of each in what is told. *)
Axes     == {Slots[i] : i \in 1..Len(Slots)}
Place(x) == CHOOSE i \in 1..Len(Slots) : Slots[i] = x
K        == TLCEval([x \in Axes |-> AxisConfigurations[Place(x)]])

Input(told) ==
  [ pedal_no |-> told[1][1], pedal_nc |-> told[1][2], estop_loop |-> told[1][3],
    deadline_missed |-> told[1][4], new_attachment |-> told[1][5], config_pass |-> told[1][6],
    any_valid |-> TRUE, state_damaged |-> FALSE,
    readings |-> [x \in Axes |-> LET reading == told[1][7][Place(x)]
                                 IN  [frame |-> reading[1], moved |-> reading[2], switch |-> reading[3]]],
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

(* The same, from what was told to the model's records. *)
SystemTold(s) ==
  [ mode |-> s[1], cause |-> s[2], causes_seen |-> s[3], pedal |-> s[4], pedal_armed |-> s[5],
    pedal_pressed_ticks |-> s[6], pedal_released_ticks |-> s[7], pedal_disagree_ticks |-> s[8],
    estop |-> s[9], app_age_ticks |-> s[10], app_alive |-> s[11], holder |-> s[12],
    overruns_in_row |-> s[13], bus_bad_ticks |-> s[14], config_sound |-> s[15] ]

AxisTold(a) ==
  [ state |-> a[1], fault |-> a[2], fault_now |-> FALSE, homed |-> a[3], switch_triggered |-> a[4],
    card_valid |-> a[5], card_seen |-> a[6], bad_frames |-> a[7], ticks_since_frame |-> a[8],
    position_counts |-> a[9], delta_counts |-> a[10], setpoint_counts |-> a[11], drive |-> a[12],
    lease_ticks |-> a[13], driven_direction |-> a[14], press_travel_counts |-> a[15],
    stall_driven_ticks |-> a[16], since_stall_mark |-> a[17], stall_direction |-> a[18],
    setpoint_changed |-> a[19], since_reverse_mark |-> a[20], reverse_direction |-> a[21],
    since_drift_mark |-> a[22], undriven_ticks |-> a[23], homing_phase |-> a[24],
    homing_ticks |-> a[25], since_homing_mark |-> a[26], rest_ticks |-> a[27] ]

(* What the model says, in the order in which the kernel told it. *)
Answer(after) ==
  LET OutputOf(x) == <<after.gate[x], after.command[x].direction, after.command[x].drive>>
  IN  << [i \in 1..Len(after.answers) |-> after.answers[i].verdict], SystemAsTold(after.system),
         [i \in 1..Len(Slots) |-> AxisAsTold(after.axes[Slots[i]])],
         [i \in 1..Len(Slots) |-> OutputOf(Slots[i])] >>

Told(told) == << Verdicts(told), told[3], told[4], told[5] >>

(* A run that begins with the kernel's boot begins as the model's does. *)
Booting  == [system |-> Booted(Configuration, TRUE, 0), axes |-> [x \in Axes |-> BlankAxis]]
Starting == [system |-> SystemTold(Start[1]), axes |-> [x \in Axes |-> AxisTold(Start[2][Place(x)])]]
ASSUME FromBoot => Starting = Booting

Init ==
  /\ step = 0
  /\ kernel = Starting
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
