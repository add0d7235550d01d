---------------------------- MODULE RunLeaseRows -----------------------------
(* Phase 4: the lease. The records hold what it may read and nothing else: TLC
   fails at any other field. *)
EXTENDS Axis, TLC

ASSUME
  \A state \in AxisStates, lease \in 0..4 :
    LET a == RunLeaseDown([state |-> state, lease_ticks |-> lease])
    IN PrintT(<< state, lease, a.state, a.lease_ticks >>)
==============================================================================
