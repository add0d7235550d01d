-------------------------- MODULE ObserveDeadlineRows --------------------------
(* Phase 3, the part that concerns deadlines and the E-stop. The records hold what
   it may read and nothing else: TLC fails at any other field. *)
EXTENDS System, TLC

CONSTANTS overrun_limit

ASSUME
  \A missed \in BOOLEAN, overruns \in 0..overrun_limit, loop \in Contacts :
    LET before == [overruns_in_row |-> overruns, estop |-> <<"unread">>]
        in == [deadline_missed |-> missed, estop_loop |-> loop]
        s == ObserveEstop(ObserveDeadline([overrun_limit |-> overrun_limit], before, in), in)
    IN PrintT(<<missed, overruns, loop, s.overruns_in_row, s.estop>>)
================================================================================
