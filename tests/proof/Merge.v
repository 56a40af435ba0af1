(* The merge, the inverse of the split.

   `merge` does what `merge` of src/mend.rs does. It keeps the mesh well-formed, and undoes a split (I21). *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State Split.
Import ListNotations.

(* The corners of the higher vertex go to the lower one, and those of the last vertex get the id that is free. *)
Definition relabel kept gone last x :=
  let y := if x =? gone then kept else x in if y =? last then gone else y.
(* Whether the ends of a link agree: I6. *)
Definition agree (lk : nat -> option nat) (o : nat -> nat) h :=
  match lk h with Some g => (o h =? o (next g)) && (o (next h) =? o g) | None => true end.
(* Refused unless the walk from one vertex meets a corner of the other: they have the same root. *)
Definition merge S one other : option mesh :=
  let kept := Nat.min one other in
  let gone := Nat.max one other in
  match half_edge_of S kept, half_edge_of S gone with
  | Some k, Some g =>
      if negb (one =? other) && existsb (fun h => origin S h =? kept) (orbit (ahead S) (behind S) (size S) g) then
        let o := fun h => relabel kept gone (vertices S - 1) (origin S h) in
        Some (Mesh (faces S) (link S) (fun h => torn S h && negb (agree (link S) o h)) o (vertices S - 1))
      else None
  | _, _ => None
  end.

Lemma agree_symmetric : forall lk o h g, lk h = Some g -> lk g = Some h -> agree lk o h = agree lk o g.
Proof.
  intros. unfold agree. rewrite H, H0. rewrite (Nat.eqb_sym (o g)), (Nat.eqb_sym (o (next g))). apply andb_comm.
Qed.
Lemma relabel_joins_two : forall kept gone last x y, kept < gone -> gone <= last -> x <= last -> y <= last ->
  relabel kept gone last x = relabel kept gone last y ->
  x = y \/ (x = kept /\ y = gone) \/ (x = gone /\ y = kept).
Proof.
  intros kept gone last x y Hk Hg Hx Hy. unfold relabel.
  destruct (x =? gone) eqn:E1, (y =? gone) eqn:E2;
    repeat match goal with |- context [?a =? last] => destruct (a =? last) eqn:? end;
    repeat match goal with
    | H : (_ =? _) = true |- _ => apply Nat.eqb_eq in H
    | H : (_ =? _) = false |- _ => apply Nat.eqb_neq in H end; lia.
Qed.
Lemma half_edge_of_starts_there : forall S v h, half_edge_of S v = Some h -> h < size S /\ origin S h = v.
Proof.
  intros S v h E. apply find_some in E. destruct E as [Hs Hv]. apply in_seq in Hs. apply Nat.eqb_eq in Hv. lia.
Qed.

(* A merge of a well-formed mesh is well-formed: I2 to I8. *)
Theorem merge_keeps_well_formed : forall S one other S', well_formed S -> merge S one other = Some S' -> well_formed S'.
Proof.
  intros S one other S' W. unfold merge.
  destruct (half_edge_of S (Nat.min one other)) as [k|] eqn:Ek; [|discriminate].
  destruct (half_edge_of S (Nat.max one other)) as [g|] eqn:Eg; [|discriminate].
  apply half_edge_of_starts_there in Ek, Eg. destruct Ek as [Hk Ok], Eg as [Hg Og].
  destruct (negb (one =? other)) eqn:Ene; [|discriminate]. apply negb_true_iff, Nat.eqb_neq in Ene.
  destruct (existsb _ _) eqn:Ex; [|discriminate]. simpl. intros E. injection E as <-.
  set (kept := Nat.min one other) in *. set (gone := Nat.max one other) in *.
  assert (Hkg : kept < gone) by lia.
  assert (Hroot : same_root (link S) k g).
  { apply existsb_exists in Ex. destruct Ex as (x & Hx & Ox). apply Nat.eqb_eq in Ox.
    destruct (orbit_lists_each_once (ahead S) (behind S) (size S) (ahead_range S W) (ahead_behind S W) (size S) g) as [_ Hall]; try lia.
    apply Hall in Hx. assert (x < size S) by (eapply joined_below; eauto using (ahead_range S W)).
    apply (joined_is_same_root S) in Hx.
    eapply joined_trans; [|apply joined_sym; exact Hx]. apply (one_root _ W); auto. congruence. }
  pose proof (origin_in_range _ W g Hg) as Hlast. rewrite Og in Hlast.
  set (o := fun h => relabel kept gone (vertices S - 1) (origin S h)).
  constructor; simpl.
  - apply (is_manifold _ W).
  - intros h Hh. change (o h < vertices S - 1). unfold o, relabel. pose proof (origin_in_range _ W h Hh).
    destruct (origin S h =? gone) eqn:E1;
      [destruct (kept =? vertices S - 1) eqn:E2 | destruct (origin S h =? vertices S - 1) eqn:E2];
      apply Nat.eqb_eq in E1 || apply Nat.eqb_neq in E1; apply Nat.eqb_eq in E2 || apply Nat.eqb_neq in E2; lia.
  - intros h x E. rewrite (torn_both_sides _ W _ _ E).
    rewrite (agree_symmetric _ _ _ _ E (link_is_involution _ _ (is_manifold _ W) _ _ E)). auto.
  - intros h E. rewrite (boundary_not_torn _ W _ E). auto.
  - intros h x E. pose proof (pair_agrees _ W _ _ E) as Ha. unfold agree. rewrite E.
    fold (o h) (o (next x)) (o (next h)) (o x).
    destruct (torn S h) eqn:Et; simpl.
    + rewrite negb_false_iff, andb_true_iff, !Nat.eqb_eq. tauto.
    + destruct Ha as [Ha _]. destruct Ha as [H1 H2]; auto. unfold o. rewrite H1, H2. tauto.
  - intros h x Hh Hx E. unfold size in Hh, Hx; simpl in Hh, Hx.
    pose proof (origin_in_range _ W h Hh). pose proof (origin_in_range _ W x Hx).
    apply relabel_joins_two in E; try lia. destruct E as [E|[[E1 E2]|[E1 E2]]].
    + apply (one_root _ W); auto.
    + apply (joined_trans _ h k x); [apply (one_root _ W); auto; congruence|].
      apply (joined_trans _ k g x); auto. apply (one_root _ W); auto; congruence.
    + apply (joined_trans _ h g x); [apply (one_root _ W); auto; congruence|].
      apply (joined_trans _ g k x); [apply joined_sym; auto|]. apply (one_root _ W); auto; congruence.
Qed.

(* I21: a merge of the two halves of the last split gives back what there was. *)
Theorem merge_undoes_split : forall S v moves S' S'', well_formed S -> v < vertices S ->
  split S v moves = Some S' -> merge S' v (vertices S) = Some S'' ->
  link S'' = link S /\ vertices S'' = vertices S /\
  (forall h, h < size S -> origin S'' h = origin S h /\ torn S'' h = torn S h).
Proof.
  intros S v moves S' S'' W Hv Hs Hm. pose proof (split_keeps_well_formed _ _ _ _ W Hs) as W'.
  destruct (split_changes_nothing_else _ _ _ _ W Hs) as (Hf & Hl & Hc & Ho & _).
  unfold merge in Hm. replace (Nat.min v (vertices S)) with v in Hm by lia.
  replace (Nat.max v (vertices S)) with (vertices S) in Hm by lia.
  destruct (half_edge_of S' v); [|discriminate]. destruct (half_edge_of S' (vertices S)); [|discriminate].
  destruct (negb _ && _); [|discriminate]. injection Hm as <-. simpl. rewrite Hl, Hc.
  replace (1 + vertices S - 1) with (vertices S) by lia.
  assert (Hback : forall h, h < size S -> relabel v (vertices S) (vertices S) (origin S' h) = origin S h).
  { intros h Hh. rewrite Ho by auto. pose proof (origin_in_range _ W h Hh). unfold relabel.
    assert (Hn : origin S h =? vertices S = false) by (apply Nat.eqb_neq; lia).
    assert (Hn' : v =? vertices S = false) by (apply Nat.eqb_neq; lia).
    destruct ((origin S h =? v) && moves h) eqn:E.
    - rewrite Nat.eqb_refl, Hn'. apply andb_true_iff in E. destruct E as [E _]. apply Nat.eqb_eq in E. auto.
    - rewrite Hn, Hn. auto. }
  repeat split; auto. unfold agree. destruct (link S h) as [g|] eqn:E.
  - destruct (link_in_range _ _ (is_manifold _ W) _ _ E) as [_ Hg].
    assert (next h < size S) by (apply next_below; auto). assert (next g < size S) by (apply next_below; auto).
    rewrite !Hback by auto. pose proof (pair_agrees _ W _ _ E) as Ha.
    assert (E' : link S' h = Some g) by congruence. pose proof (pair_agrees _ W' _ _ E') as Ha'.
    destruct ((origin S h =? origin S (next g)) && (origin S (next h) =? origin S g)) eqn:Eb.
    + rewrite andb_true_iff, !Nat.eqb_eq in Eb. destruct Ha as [_ Ha]. rewrite (Ha Eb). apply andb_false_r.
    + rewrite andb_false_iff, !Nat.eqb_neq in Eb. simpl. rewrite andb_true_r.
      destruct (torn S h) eqn:Et; [|destruct Ha as [Ha _]; destruct (Ha eq_refl); tauto].
      destruct (torn S' h) eqn:Et'; auto. exfalso.
      destruct Ha' as [Ha' _]. destruct (Ha' eq_refl) as [Ea Eb2].
      rewrite <- (Hback h), <- (Hback (next g)), <- (Hback (next h)), <- (Hback g) in Eb by auto.
      rewrite Ea, Eb2 in Eb. tauto.
  - rewrite (boundary_not_torn _ W _ E), andb_false_r. auto.
Qed.

