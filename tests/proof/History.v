(* Any history of edits. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State Split Merge Cone Insert.
Import ListNotations.

Inductive edit (S S' : mesh) : Prop :=
| by_split : forall v moves, split S v moves = Some S' -> edit S S'
| by_merge : forall one other, merge S one other = Some S' -> edit S S'
| by_insertion_in_face : forall f, insert_in_face S f = Some S' -> edit S S'
| by_insertion_on_edge : forall h, insert_on_edge S h = Some S' -> edit S S'.
Definition is_insertion S S' :=
  (exists f, insert_in_face S f = Some S') \/ (exists h, insert_on_edge S h = Some S').

Lemma edit_keeps_well_formed : forall S S', well_formed S -> edit S S' -> well_formed S'.
Proof.
  intros S S' W [v moves E|one other E|f E|h E].
  - eapply split_keeps_well_formed; eauto. - eapply merge_keeps_well_formed; eauto.
  - eapply insert_in_face_keeps_well_formed; eauto. - eapply insert_on_edge_keeps_well_formed; eauto.
Qed.
Lemma edit_keeps_links : forall S S', well_formed S -> edit S S' ->
  (link S' = link S /\ faces S' = faces S) \/ is_insertion S S'.
Proof.
  intros S S' W [v moves E|one other E|f E|h E]; [left|left|right; left; eauto|right; right; eauto].
  - destruct (split_changes_nothing_else _ _ _ _ W E) as (E1 & E2 & _). auto.
  - unfold merge in E. destruct (half_edge_of S _); [|discriminate]. destruct (half_edge_of S _); [|discriminate].
    destruct (negb _ && _); [|discriminate]. injection E as <-. auto.
Qed.

Inductive history (S0 : mesh) : mesh -> Prop :=
| start : history S0 S0
| then_edit : forall S S', history S0 S -> edit S S' -> history S0 S'.
(* With splits and merges alone. *)
Inductive tearing (S0 : mesh) : mesh -> Prop :=
| uncut : tearing S0 S0
| then_tear : forall S S', tearing S0 S -> edit S S' -> ~ is_insertion S S' -> tearing S0 S'.

(* Whatever splits, merges and insertions there were: I2 to I8 hold, and the walk is exact (I10). *)
Theorem walk_is_exact_after_any_history : forall S0 S, well_formed S0 -> history S0 S ->
  well_formed S /\
  forall v, NoDup (corners_of S v) /\ forall h, In h (corners_of S v) <-> h < size S /\ origin S h = v.
Proof.
  intros S0 S W H. assert (W' : well_formed S) by (induction H; eauto using edit_keeps_well_formed).
  split; auto. intros v. apply (walk_lists_exactly_the_corners S W' v).
Qed.
(* Whatever splits and merges there were: the links are those of the input (I15). *)
Theorem links_stay_while_tearing : forall S0 S, well_formed S0 -> tearing S0 S ->
  link S = link S0 /\ faces S = faces S0.
Proof.
  intros S0 S W H. assert (Hk : well_formed S /\ link S = link S0 /\ faces S = faces S0); [|tauto].
  induction H as [|S S' H IH E Hn]; auto. destruct IH as (W' & El & Ef). split; [eapply edit_keeps_well_formed; eauto|].
  destruct (edit_keeps_links _ _ W' E) as [[E1 E2]|Hi]; [|tauto]. split; congruence.
Qed.
