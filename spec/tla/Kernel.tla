-------------------------------- MODULE Kernel --------------------------------
(* One whole tick of the kernel: its eight phases over the system and its axes.
   Operators only. `K` gives the configuration of each axis and so says which axes
   there are; `axes` gives their records. `in` is what System reads, with readings
   (one for each axis), requests (a sequence, each with its door) and state_damaged. *)
EXTENDS System, Homing, TLC

(* A function of the axes, evaluated at once and not anew at each use. *)
Each(names, Of(_)) == TLCEval([x \in names |-> Of(x)])

(* After an integrity failure of the state nothing in it is known. *)
UnknownAxis == [BlankAxis EXCEPT !.state = "FAULTED", !.fault = "INTEGRITY", !.fault_now = TRUE]

(* Phase 1: nothing of a damaged state is looked at; the tick goes on with a new one. *)
CheckState(c, kernel, in) ==
  IF in.state_damaged
  THEN [ system |-> Rebuilt(c, "INTEGRITY", 0),
         axes   |-> LET Unknown(x) == UnknownAxis IN Each(DOMAIN kernel.axes, Unknown) ]
  ELSE kernel

(* Phases 2 to 4: the cards, the system's inputs, then each axis. *)
ObserveAxes(c, K, s, axes, in) ==
  LET One(x) == ObserveAxis(s, c, K[x], ObserveCard(c, K[x], axes[x], in, in.readings[x]),
                            in.readings[x])
  IN  Each(DOMAIN axes, One)

(* A DISABLED axis has moved farther than drift, not long ago. *)
IsRestless(k, a) == a.state = "DISABLED" /\ a.card_seen /\ a.hand.ticks < k.rest_ticks

Alarms(c, K, axes, in) ==
  [ configuration_damaged |-> in.config_pass = "DIFFERS",
    new_fault |-> \E x \in DOMAIN axes : axes[x].fault_now,
    required_card_lost |-> \E x \in DOMAIN axes : K[x].required /\ CardIsLost(c, axes[x]),
    runaway |-> \E x \in DOMAIN axes : axes[x].runaway,
    restless |-> \E x \in DOMAIN axes : IsRestless(K[x], axes[x]) ]

(* Phase 5: a new mode acts on every axis. *)
FollowSystem(before, after, axes) ==
  LET One(x) == FollowMode(before.mode, after.mode, axes[x]) IN Each(DOMAIN axes, One)

Observe(c, K, kernel, in) ==
  LET input   == [in EXCEPT !.any_valid = \E x \in DOMAIN K : in.readings[x].valid]
      checked == CheckConfiguration(kernel.system, input)
      system  == ObserveSystem(c, ObserveBus(c, checked, input), input)
      axes    == ObserveAxes(c, K, kernel.system, kernel.axes, in)
      changed == ChangeMode(c, system, Alarms(c, K, axes, in), in.consent)
  IN  [system |-> changed, axes |-> FollowSystem(system, changed, axes)]

(* Phase 6: one request. *)
Judge(c, K, kernel, request) ==
  LET door == JudgeDoor(request, DOMAIN K)
  IN  IF door # "ACCEPTED" THEN door
      ELSE IF request.kind \in SystemKinds THEN JudgeSystem(kernel.system, request)
      ELSE JudgeAxis(c, K[request.axis], kernel.system, kernel.axes[request.axis], request)

Apply(kernel, request) ==
  IF request.kind \in SystemKinds
  THEN LET after == ApplySystem(kernel.system, request)
       IN  [system |-> after, axes |-> FollowSystem(kernel.system, after, kernel.axes)]
  ELSE [kernel EXCEPT !.axes[request.axis] = ApplyAxis(@, request)]

(* Phase 6: all requests in their order, one answer each. *)
RECURSIVE AnswerAll(_, _, _, _, _)
AnswerAll(c, K, kernel, requests, answers) ==
  IF requests = <<>> THEN [kernel |-> kernel, answers |-> answers]
  ELSE LET request == Head(requests)
           verdict == Judge(c, K, kernel, request)
           after   == IF verdict = "ACCEPTED" THEN Apply(kernel, request) ELSE kernel
           answer  == [request |-> request, verdict |-> verdict, before |-> kernel, after |-> after]
       IN  AnswerAll(c, K, after, Tail(requests), Append(answers, answer))

(* Phase 7, and the end of the tick. *)
Drive(K, kernel) ==
  LET One(x) == DriveAxis(K[x], kernel.system, kernel.axes[x])
  IN  Each(DOMAIN kernel.axes, One)

(* Phases 1 to 5, which no request of the tick has a part in; then 7 and 8, after 6. *)
Observed(c, K, kernel, in) ==
  LET start == CheckState(c, kernel, in)
  IN  TLCEval(IF start.system.mode = "INIT" THEN start ELSE Observe(c, K, start, in))

Finished(K, observed, answered) ==
  LET driven == Drive(K, answered.kernel)
      AxisOf(x)    == [driven[x].axis EXCEPT !.fault_now = FALSE, !.disabled_now = FALSE]
      CommandOf(x) == driven[x].command
      GateOf(x)    == driven[x].gate
  IN  [ system   |-> answered.kernel.system,
        axes     |-> Each(DOMAIN driven, AxisOf),
        command  |-> Each(DOMAIN driven, CommandOf),
        gate     |-> Each(DOMAIN driven, GateOf),
        answers  |-> answered.answers,
        observed |-> observed ]

Tick(c, K, kernel, in) ==
  LET observed == Observed(c, K, kernel, in)
  IN  Finished(K, observed, TLCEval(AnswerAll(c, K, observed, in.requests, <<>>)))
===============================================================================
