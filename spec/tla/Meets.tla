-------------------------------- MODULE Meets --------------------------------
(* How a model tells what its search has met. *)
EXTENDS TLC

(* TRUE. Says, once, that an action was taken or that what a property is about has
   happened: an action that is never taken, or a property of nothing, would be told
   by silence. *)
ASSUME TLCSet(1, {})
Met(name) ==
  IF name \in TLCGet(1) THEN TRUE
  ELSE TLCSet(1, TLCGet(1) \union {name}) /\ PrintT(<<"met", name>>)
===============================================================================
