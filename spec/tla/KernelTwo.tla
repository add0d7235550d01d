------------------------------- MODULE KernelTwo ------------------------------
(* Two axes and the system: what axes do to each other. Axis 1 has a switch and a
   card that MOTION needs; axis 2 has neither. The plant is coarse: in a tick one
   axis goes a count, jumps, or loses its frame; the others stand. *)
EXTENDS Kernel, Meets

CONSTANTS c, first, second  \* configurations: the system, axis 1, axis 2

SmallSystem ==
  [ pedal_channels |-> 1, app_timeout_ticks |-> 2, lease_max_ticks |-> 1,
    pedal_debounce_ticks |-> 1, pedal_disagree_ticks |-> 1,
    bad_frame_limit |-> 2, overrun_limit |-> 2 ]

WithSwitch ==
  [ limit_side |-> "LOWER", min_counts |-> -1, max_counts |-> 1,
    home_offset_counts |-> -1, coast_counts |-> 0, deadband_counts |-> 0,
    max_drive |-> 1, unhomed_max_drive |-> 1, unhomed_travel_counts |-> 1,
    home_drive |-> 1, home_travel_counts |-> 2, home_backoff_counts |-> 1,
    home_timeout_ticks |-> 2, home_rest_ticks |-> 1, stall_ticks |-> 2,
    stall_min_counts |-> 1, reverse_counts |-> 1, drift_counts |-> 0,
    settle_ticks |-> 1, max_delta_counts |-> 1, required |-> TRUE ]

WithoutSwitch == [WithSwitch EXCEPT !.limit_side = "NONE", !.required = FALSE]

Axes == {1, 2}
K    == (1 :> first) @@ (2 :> second)

VARIABLES system, axes, seen, io

vars == <<system, axes, seen, io>>

(* What no later tick looks at is set to one value, so that states that will behave
   alike are one. Positions and marks, which this plant could let grow without end,
   are forgotten as well: this model is not about one axis' motion. *)
Forget(s, a) ==
  [a EXCEPT !.delta_counts = 0, !.card_valid = FALSE, !.switch_triggered = FALSE,
            !.ticks_since_frame = IF a.card_valid THEN 0 ELSE @,
            !.position_counts = 0, !.press_travel_counts = 0, !.since_homing_mark = 0,
            !.since_stall_mark = 0, !.since_reverse_mark = 0, !.since_drift_mark = 0,
            !.stall_direction = "NONE", !.reverse_direction = "NONE",
            !.homing_ticks = IF a.homing_phase = "NONE" THEN 0 ELSE @,
            !.rest_ticks = IF a.homing_phase = "REST" THEN @ ELSE 0]

ForgetSystem(s) == [s EXCEPT !.causes_seen = {}, !.app_alive = FALSE, !.estop = FALSE,
                             !.pedal = "DISAGREE"]

View == <<system, axes, seen>>

-------------------------------------------------------------------------------
(* Inputs and requests *)
Wish(kind, x) == [kind |-> kind, door |-> "INTACT", axis |-> x, holder |-> 1,
                  target |-> 1, drive |-> 1, lease |-> 1]

Wishes ==
  {Wish(kind, x) : kind \in {"ENABLE", "CLEAR_FAULT", "MOVE", "HOME"}, x \in Axes}
  \union {Wish(kind, 1) : kind \in {"DISABLE", "STOP", "RESET"}} \union {Wish("ENABLE", 3)}

Alive(holder) == <<[Wish("HEARTBEAT", 0) EXCEPT !.holder = holder]>>

Still == [frame |-> "GOOD", moved |-> 0, switch |-> FALSE]

Input(pedal, estop, one, two, requests) ==
  [ pedal_no |-> pedal, pedal_nc |-> "OPEN", estop_loop |-> estop, deadline_missed |-> FALSE,
    new_attachment |-> FALSE, config_pass |-> "NONE", any_valid |-> FALSE,
    readings |-> (1 :> one) @@ (2 :> two), requests |-> requests, state_damaged |-> FALSE ]

Held == IF system.mode = "MOTION" \/ system.pedal_armed THEN "CLOSED" ELSE "OPEN"

Happenings == {[Still EXCEPT !.moved = 5], [Still EXCEPT !.frame = "MISSING"],
               [Still EXCEPT !.switch = TRUE]}

-------------------------------------------------------------------------------
(* A tick *)
NoTick == [in |-> Input("OPEN", "CLOSED", Still, Still, <<>>), system |-> system,
           axes |-> axes, observed |-> axes,
           command |-> [x \in Axes |-> NoDrive], answers |-> <<>>]

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
    /\ axes' = [x \in Axes |-> Forget(tick.system, tick.axes[x])]
    /\ seen' = [x \in Axes |-> /\ tick.system.mode = "MOTION"
                               /\ seen[x] \/ Accepted(tick, {"MOVE", "HOME"}, x)]
    /\ io' = [in |-> in, system |-> tick.system, axes |-> tick.axes,
              observed |-> tick.observed.axes, command |-> tick.command,
              answers |-> tick.answers]

OrdinaryTick == Met("OrdinaryTick") /\ \E pedal \in {"CLOSED", "OPEN"} :
  Step(Input(pedal, "CLOSED", Still, Still, Alive(1)))

RequestTick == Met("RequestTick") /\ \E wish \in Wishes :
  Step(Input(Held, "CLOSED", Still, Still, Append(Alive(1), wish)))

EstopTick     == Met("EstopTick") /\ Step(Input(Held, "OPEN", Still, Still, Alive(1)))
SilentTick    == Met("SilentTick") /\ Step(Input(Held, "CLOSED", Still, Still, <<>>))
NewHolderTick == Met("NewHolderTick") /\ Step(Input(Held, "CLOSED", Still, Still, Alive(3 - system.holder)))

EventTick == Met("EventTick") /\ \E event \in Happenings :
  \/ Step(Input(Held, "CLOSED", event, Still, Alive(system.holder)))
  \/ Step(Input(Held, "CLOSED", Still, event, Alive(system.holder)))

Next == OrdinaryTick \/ RequestTick \/ EstopTick \/ SilentTick \/ NewHolderTick \/ EventTick
Spec == Init /\ [][Next]_vars

-------------------------------------------------------------------------------
(* Properties, as in kernel.md *)
Driven(x) == io'.command[x].drive # 0

P1_gate ==
  [][ \A x \in Axes : Driven(x) =>
        /\ io'.system.mode = "MOTION"
        /\ io'.in.pedal_no = "CLOSED"
        /\ io'.in.estop_loop = "CLOSED"
        /\ io'.in.readings[x].frame = "GOOD"
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
      /\ NewFault /\ axes[1].state = "HOMING" /\ axes[2].state = "ENABLED" => Met("P2_new_fault")
      /\ RequiredLost /\ system.pedal_armed => Met("P2_required_card")
      /\ (\A x \in Axes : axes'[x].state = "FAULTED") => Met("P8_latch")
      /\ \A i \in 1..Len(io'.answers) :
           io'.answers[i].verdict = "NO_SWITCH" => Met("P11_inert_refusal")
      /\ Accepted(io', {"MOVE"}, 2) => Met("P11_other_axis") /\ Met("P12_no_leap") ]_vars
===============================================================================
