(* The merge, the inverse of the split.

   `merge` does what `merge` of src/mend.rs does. It keeps the mesh well-formed, joins any two vertices of one root and
   no others, changes nothing but what I16 says, and undoes a split (I21). *)
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
    apply (orbit_is_root S W g x Hg) in Hx. destruct Hx as [Hx' Hx].
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

(* A merge is refused if the vertices are one, or have no corners of one root; and only then. *)
Lemma merge_is_symmetric : forall S one other, merge S one other = merge S other one.
Proof.
  intros S one other. unfold merge. rewrite (Nat.min_comm other), (Nat.max_comm other), (Nat.eqb_sym other). auto.
Qed.
Lemma half_edge_is_found : forall S v h, h < size S -> origin S h = v -> exists k, half_edge_of S v = Some k.
Proof.
  intros S v h Hh E. unfold half_edge_of. destruct (find _ _) eqn:F; eauto.
  assert (Hs : In h (seq 0 (size S))) by (apply in_seq; lia).
  pose proof (find_none _ _ F h Hs) as H. simpl in H. apply Nat.eqb_neq in H. contradiction.
Qed.
Theorem merge_joins_one_root : forall S one other, well_formed S ->
  ((exists S', merge S one other = Some S') <->
   one <> other /\
   exists h g, h < size S /\ g < size S /\ origin S h = one /\ origin S g = other /\ same_root (link S) h g).
Proof.
  intros S one other W.
  assert (Hlower : forall a b, a < b -> ((exists S', merge S a b = Some S') <->
    exists h g, h < size S /\ g < size S /\ origin S h = a /\ origin S g = b /\ same_root (link S) h g)).
  { intros a b Hab. unfold merge. replace (Nat.min a b) with a by lia. replace (Nat.max a b) with b by lia.
    replace (a =? b) with false by (symmetry; apply Nat.eqb_neq; lia). simpl. split.
    - intros [S' E]. destruct (half_edge_of S a) as [k|] eqn:Ek; [|discriminate].
      destruct (half_edge_of S b) as [g|] eqn:Eg; [|discriminate]. destruct (existsb _ _) eqn:Ex; [|discriminate].
      apply half_edge_of_starts_there in Eg. apply existsb_exists in Ex. destruct Ex as (h & Hh & Oh).
      apply Nat.eqb_eq in Oh. apply (orbit_is_root S W g h) in Hh; [|tauto]. exists h, g.
      repeat split; try tauto. apply joined_sym. tauto.
    - intros (h & g & Hh & Hg & Oh & Og & R). destruct (half_edge_is_found S a h) as [x ->]; auto.
      destruct (half_edge_is_found S b g) as [y Ey]; auto. rewrite Ey.
      apply half_edge_of_starts_there in Ey. destruct Ey as [Hy Oy].
      replace (existsb _ _) with true; eauto. symmetry. apply existsb_exists. exists h.
      rewrite Oh, Nat.eqb_refl. split; auto. apply (orbit_is_root S W); auto. split; auto.
      eapply joined_trans; [|apply joined_sym; exact R]. apply (one_root _ W); auto. congruence. }
  destruct (Nat.lt_total one other) as [H|[->|H]].
  - rewrite Hlower by auto. intuition lia.
  - unfold merge. rewrite Nat.eqb_refl. simpl. split; [|tauto]. intros [S' E].
    destruct (half_edge_of _ _); [destruct (half_edge_of _ _)|]; discriminate.
  - rewrite merge_is_symmetric, Hlower by auto. split.
    + intros (h & g & H1). split; [lia|]. exists g, h. repeat split; try tauto. apply joined_sym. tauto.
    + intros (_ & h & g & H1). exists g, h. repeat split; try tauto. apply joined_sym. tauto.
Qed.

(* I15, I16: links stay; the corners of the higher vertex are at the lower one, those of the last vertex have the id that
   is free, every other corner is where it was; of the torn links those are sewn whose ends agree. *)
Theorem merge_changes_nothing_else : forall S one other S', well_formed S -> merge S one other = Some S' ->
  let kept := Nat.min one other in let gone := Nat.max one other in
  faces S' = faces S /\ link S' = link S /\ vertices S = 1 + vertices S' /\
  (forall h, origin S' h = if origin S h =? gone then kept else if origin S h =? vertices S' then gone else origin S h) /\
  (forall h, torn S' h = torn S h && negb (agree (link S) (origin S') h)).
Proof.
  intros S one other S' W Em kept gone. unfold merge in Em. fold kept gone in Em.
  destruct (half_edge_of S kept); [|discriminate]. destruct (half_edge_of S gone) as [g|] eqn:Eg; [|discriminate].
  destruct (negb (one =? other)) eqn:En; [|discriminate]. destruct (existsb _ _); [|discriminate]. injection Em as <-.
  apply negb_true_iff, Nat.eqb_neq in En. apply half_edge_of_starts_there in Eg. destruct Eg as [Hg Og].
  pose proof (origin_in_range _ W g Hg). simpl. repeat split; auto; [lia|]. intros h. unfold relabel.
  destruct (origin S h =? gone); auto. destruct (Nat.eqb_spec kept (vertices S - 1)); auto. lia.
Qed.

(* I21: a merge of the two halves of the last split succeeds, and gives back what there was. *)
Theorem merge_undoes_split : forall S v moves S', well_formed S -> split S v moves = Some S' ->
  exists S'', merge S' v (vertices S) = Some S'' /\
    faces S'' = faces S /\ vertices S'' = vertices S /\ link S'' = link S /\
    (forall h, h < size S -> origin S'' h = origin S h) /\ (forall h, torn S'' h = torn S h).
Proof.
  intros S v moves S' W Hs. pose proof (split_keeps_well_formed _ _ _ _ W Hs) as W'.
  destruct (split_changes_nothing_else _ _ _ _ W Hs) as (Hf & Hl & Hc & Ho & _).
  destruct (split_leaves_both_sides _ _ _ _ W Hs) as (a & b & (Ha & Oa & Ma) & (Hb & Ob & Mb)).
  assert (Hv : v < vertices S) by (rewrite <- Oa; apply (origin_in_range _ W); auto).
  assert (Hm : exists S'', merge S' v (vertices S) = Some S'').
  { apply (merge_joins_one_root S' v (vertices S) W'). split; [lia|]. exists b, a.
    unfold size. rewrite Hf, Hl, !Ho by auto. rewrite Oa, Ob, Ma, Mb, Nat.eqb_refl. repeat split; auto.
    apply (one_root _ W); auto. congruence. }
  destruct Hm as [S'' Hm]. exists S''. split; auto. pose proof (merge_keeps_well_formed _ _ _ _ W' Hm) as W''.
  destruct (merge_changes_nothing_else _ _ _ _ W' Hm) as (Ef & El & Ev & Eo & _). rewrite Hc in Ev. injection Ev as Ev.
  assert (Hback : forall h, h < size S -> origin S'' h = origin S h).
  { intros h Hh. rewrite Eo, Ho, <- Ev by auto. replace (Nat.min v (vertices S)) with v by lia.
    replace (Nat.max v (vertices S)) with (vertices S) by lia. pose proof (origin_in_range _ W h Hh).
    assert (Hn : origin S h =? vertices S = false) by (apply Nat.eqb_neq; lia).
    destruct ((origin S h =? v) && moves h) eqn:E; [|rewrite Hn; auto].
    apply andb_true_iff in E. destruct E as [E _]. apply Nat.eqb_eq in E. rewrite Nat.eqb_refl. auto. }
  assert (Hlink : link S'' = link S) by congruence.
  repeat split; auto using marks_follow; congruence.
Qed.
