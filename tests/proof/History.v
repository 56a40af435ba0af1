(* Any history of edits. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State Split Merge.
Import ListNotations.

(* Whatever splits and merges there were: the links are those of the input (I15), and the walk is exact (I10). *)
Inductive history (S0 : mesh) : mesh -> Prop :=
| start : history S0 S0
| by_split : forall S v moves S', history S0 S -> split S v moves = Some S' -> history S0 S'
| by_merge : forall S one other S', history S0 S -> merge S one other = Some S' -> history S0 S'.

Theorem walk_is_exact_after_any_history : forall S0 S, well_formed S0 -> history S0 S ->
  well_formed S /\ link S = link S0 /\ faces S = faces S0 /\
  forall v, NoDup (corners_of S v) /\ forall h, In h (corners_of S v) <-> h < size S0 /\ origin S h = v.
Proof.
  intros S0 S W H. assert (Hk : well_formed S /\ link S = link S0 /\ faces S = faces S0).
  { induction H; auto; destruct IHhistory as (W1 & L & F).
    - split; [eapply split_keeps_well_formed; eauto|]. destruct (split_changes_nothing_else _ _ _ _ W1 H0) as (E1 & E2 & _). split; congruence.
    - split; [eapply merge_keeps_well_formed; eauto|]. unfold merge in H0.
      destruct (half_edge_of S _); [|discriminate]. destruct (half_edge_of S _); [|discriminate].
      destruct (negb _ && _); [|discriminate]. injection H0 as <-. auto. }
  destruct Hk as (W1 & L & F). split; [auto|split; [auto|split; [auto|]]]. intros v.
  replace (size S0) with (size S) by (unfold size; congruence). apply (walk_lists_exactly_the_corners S W1 v).
Qed.

