------------------------------- MODULE KernelTwo ------------------------------
(* Two axes and the system: what axes do to each other. Axis 1 has a switch and a
   card that MOTION needs; axis 2 has neither. The plant is coarse: in a tick each axis
   stands, goes a count, jumps, or loses its frame. *)
EXTENDS Kernel, Meets

CONSTANTS c, first, second  \* configurations: the system, axis 1, axis 2

SmallSystem ==
  [ pedal_channels |-> 1, app_timeout_ticks |-> 2, lease_max_ticks |-> 1,
    power_up_ticks |-> 0, pedal_debounce_ticks |-> 1, pedal_disagree_ticks |-> 1,
    bad_frame_limit |-> 2, overrun_limit |-> 2 ]

WithSwitch ==
  [ limit_side |-> "LOWER", min_counts |-> -3, max_counts |-> 3, home_offset_counts |-> -1,
    coast_counts |-> 0, deadband_counts |-> 0, noise_counts |-> 0, max_drive |-> 1,
    unhomed_max_drive |-> 1, unhomed_travel_counts |-> 3, home_drive |-> 1, home_slow_drive |-> 1,
    home_travel_counts |-> 9, home_clear_counts |-> 1, home_tolerance_counts |-> 0,
    home_timeout_ticks |-> 9, switch_hysteresis_counts |-> 0, switch_debounce_ticks |-> 1,
    rest_ticks |-> 0, stall_ticks |-> 9, stall_effort_ticks |-> 0, stall_min_counts |-> 1,
    reverse_counts |-> 1, drift_counts |-> 1, max_delta_counts |-> 2, required |-> TRUE ]

WithoutSwitch == [WithSwitch EXCEPT !.limit_side = "NONE", !.required = FALSE]

Axes == {1, 2}
K    == (1 :> first) @@ (2 :> second)

VARIABLES system, axes, seen, io

vars == <<system, axes, seen, io>>

(* What no later tick looks at is set to one value. Positions, marks and sums are
   forgotten as well: this model is not about one axis' motion. *)
Forget(a) ==
  [BlankAxis EXCEPT !.state = a.state, !.fault = a.fault, !.homed = a.homed,
                    !.card_seen = a.card_seen, !.bad_frames = a.bad_frames,
                    !.ticks_since_frame = IF a.card_seen THEN a.ticks_since_frame ELSE 0,
                    !.driven_direction = a.driven_direction, !.reverse_direction = a.driven_direction,
                    !.lease_ticks = a.lease_ticks, !.homing_phase = a.homing_phase,
                    !.runaway = a.runaway]

ForgetSystem(s) == [s EXCEPT !.causes_seen = {}, !.app_alive = FALSE, !.estop = FALSE,
                             !.runaway = FALSE, !.pedal = "DISAGREE"]

View == <<system, axes, seen>>

-------------------------------------------------------------------------------
(* Inputs and requests. The number of a press is 1. *)
Ask(kind, x) == [kind |-> kind, door |-> "INTACT", axis |-> x, holder |-> 1,
                 target |-> 1, drive |-> 1, lease |-> 1, consent |-> 1]

Both(one, two) == <<Ask(one, 1), Ask(two, 2)>>

(* Several in a tick, in any order that matters. *)
Talk ==
  CASE system.mode = "LOCKED" -> {<<Ask("RESET", 0)>>, Both("CLEAR_FAULT", "CLEAR_FAULT")}
    [] system.mode = "READY"  -> {<<>>, Both("ENABLE", "ENABLE"), Both("CLEAR_FAULT", "CLEAR_FAULT"),
                                  Both("ENABLE", "SET_HOME")}
    [] OTHER -> {<<>>, Both("MOVE", "MOVE"), Both("HOME", "MOVE"), Both("MOVE", "HOME"),
                 Both("DISABLE", "MOVE"), <<Ask("STOP", 0), Ask("MOVE", 1)>>,
                 <<Ask("MOVE", 3), Ask("ENABLE", 2), Ask("MOVE", 2)>>}

Alive(holder) == <<[Ask("HEARTBEAT", 0) EXCEPT !.holder = holder]>>

Still == [valid |-> TRUE, raw |-> 0, switch |-> FALSE, reset |-> FALSE]
Lost  == [Still EXCEPT !.valid = FALSE]
Gone  == [Still EXCEPT !.raw = 2]
Jump  == [Still EXCEPT !.raw = 7]

Input(pedal, estop, one, two, requests) ==
  [ pedal_no |-> pedal, pedal_nc |-> "OPEN", estop_loop |-> estop, missed |-> 0,
    new_attachment |-> FALSE, config_pass |-> "NONE", any_valid |-> FALSE, consent |-> 1,
    readings |-> (1 :> one) @@ (2 :> two), requests |-> requests, state_damaged |-> FALSE ]

Held == IF system.mode = "MOTION" \/ system.pedal_armed THEN "CLOSED" ELSE "OPEN"

-------------------------------------------------------------------------------
(* A tick *)
NoTick == [command |-> [x \in Axes |-> NoDrive]]

Init ==
  /\ system = Booted(c, TRUE, 1)
  /\ axes = [x \in Axes |-> BlankAxis]
  /\ seen = [x \in Axes |-> FALSE]
  /\ io = NoTick

Accepted(tick, kinds, x) ==
  \E i \in 1..Len(tick.answers) :
    /\ tick.answers[i].verdict = "ACCEPTED"
    /\ tick.answers[i].request.kind \in kinds
    /\ tick.answers[i].request.axis = x

(* The witness keeps for each axis whether MOVE or HOME was accepted in this MOTION. *)
Step(in) ==
  \E tick \in {Tick(c, K, [system |-> system, axes |-> axes], in)} :
    /\ system' = ForgetSystem(tick.system)
    /\ axes' = [x \in Axes |-> Forget(tick.axes[x])]
    /\ seen' = [x \in Axes |-> /\ tick.system.mode = "MOTION"
                               /\ seen[x] \/ Accepted(tick, {"MOVE", "HOME"}, x)]
    /\ io' = [in |-> in, system |-> tick.system, axes |-> tick.axes,
              observed |-> tick.observed.axes, command |-> tick.command,
              answers |-> tick.answers]

TalkTick == Met("TalkTick") /\ \E pedal \in {"CLOSED", "OPEN"}, said \in Talk :
  Step(Input(pedal, "CLOSED", Still, Still, Alive(1) \o said))

EventTick == Met("EventTick") /\ \E one \in {Still, Lost, Jump}, two \in {Still, Lost, Gone}, holder \in {1, 2} :
  Step(Input(Held, "CLOSED", one, two, Alive(holder) \o Both("ENABLE", "MOVE")))

QuietTick == Met("QuietTick") /\ \E estop \in {"OPEN", "CLOSED"}, one \in {Still, Lost} :
  Step(Input(Held, estop, one, one, <<>>))

Next == TalkTick \/ EventTick \/ QuietTick
Spec == Init /\ [][Next]_vars

-------------------------------------------------------------------------------
(* Properties, as in kernel.md *)
Driven(x) == io'.command[x].drive # 0

P1_gate ==
  [][ \A x \in Axes : Driven(x) =>
        /\ io'.system.mode = "MOTION"
        /\ io'.in.pedal_no = "CLOSED"
        /\ io'.in.estop_loop = "CLOSED"
        /\ io'.in.readings[x].valid
        /\ io'.axes[x].state \in {"MOVING", "HOMING"} ]_vars

(* A new fault of any axis ends MOTION for all; so all homing ends as one. *)
NewFault == \E x \in Axes : axes[x].state # "FAULTED" /\ io'.observed[x].state = "FAULTED"

P2_new_fault ==
  [][ system.mode = "MOTION" /\ NewFault
      => /\ system'.mode # "MOTION"
         /\ \A x \in Axes : ~Driven(x) /\ axes'[x].state \notin {"MOVING", "HOMING"} ]_vars

(* A required card that is lost ends MOTION and keeps it from beginning. *)
RequiredLost == \E x \in Axes : K[x].required /\ io'.axes[x].bad_frames >= c.bad_frame_limit

P2_required_card == [][ RequiredLost => system'.mode # "MOTION" ]_vars

P8_latch ==
  [][ /\ system.mode = "LOCKED" /\ ~(\E x \in 0..3 : Accepted(io', {"RESET"}, x))
         => system'.mode = "LOCKED" /\ system'.cause = system.cause
      /\ \A x \in Axes : axes[x].state = "FAULTED" /\ ~Accepted(io', {"CLEAR_FAULT"}, x)
         => axes'[x].state = "FAULTED" /\ axes'[x].fault = axes[x].fault ]_vars

P11_inert_refusal ==
  [][ /\ Len(io'.answers) = Len(io'.in.requests)
      /\ \A i \in 1..Len(io'.answers) :
           io'.answers[i].verdict # "ACCEPTED" => io'.answers[i].after = io'.answers[i].before ]_vars

(* A request to one axis does nothing to the other. *)
P11_other_axis ==
  [][ \A i \in 1..Len(io'.answers), x \in Axes :
        io'.answers[i].request.kind \in AxisKinds /\ io'.answers[i].request.axis # x
        => io'.answers[i].after.axes[x] = io'.answers[i].before.axes[x] ]_vars

P12_no_leap == [][ \A x \in Axes : Driven(x) => seen'[x] ]_vars

TypeOK ==
  /\ system.mode # "MOTION" => \A x \in Axes : axes[x].state \notin {"MOVING", "HOMING"}
  /\ system.mode = "LOCKED" => \A x \in Axes : axes[x].state \in {"DISABLED", "FAULTED"}

-------------------------------------------------------------------------------
(* What the properties are about does happen: each says so. *)
About ==
  [][ /\ Driven(1) /\ Driven(2) => Met("P1_gate")
      /\ NewFault /\ axes[1].state = "HOMING" => Met("P2_new_fault")
      /\ RequiredLost /\ system.pedal_armed => Met("P2_required_card")
      /\ (\A x \in Axes : axes'[x].state = "FAULTED") => Met("P8_latch")
      /\ (\E i \in 1..Len(io'.answers) : io'.answers[i].verdict = "NO_SWITCH") => Met("P11_inert_refusal")
      /\ Accepted(io', {"MOVE"}, 2) => Met("P11_other_axis") /\ Met("P12_no_leap") ]_vars
===============================================================================
