(* The walk round a vertex, over any partial injection of a finite set: I10 without a mesh.

   `ahead` is the turn to the next corner, ρ of invariants.md, and `behind` its inverse. The corners that are joined by
   turns form a cycle or a path. `orbit` is the loop of src/mesh/walk.rs; `orbit_lists_each_once` says that it lists
   each of them, once, and nothing else. The loop in Rust has no fuel; `orbit_ends` says that it needs none: any fuel
   that is at least the number of corners gives the same list. *)
Require Import Arith List Lia Bool Permutation Relations.
Import ListNotations.

Section Walk.
Variables ahead behind : nat -> option nat.
Variable N : nat.
Hypothesis in_range : forall x y, ahead x = Some y -> x < N /\ y < N.
Hypothesis inverse : forall x y, ahead x = Some y <-> behind y = Some x.

Lemma ahead_injective : forall x y z, ahead x = Some z -> ahead y = Some z -> x = y.
Proof. intros x y z Hx Hy. apply inverse in Hx, Hy. congruence. Qed.

(* Ahead until there is no next corner, or the first comes again. The flag says that there was no next one. *)
Fixpoint go_ahead (fuel first h : nat) : list nat * bool :=
  match fuel with
  | 0 => ([], false)
  | S fuel =>
      match ahead h with
      | None => ([h], true)
      | Some g => if g =? first then ([h], false)
                  else let (l, open) := go_ahead fuel first g in (h :: l, open)
      end
  end.

(* On from a corner, until there is none behind it. *)
Fixpoint go_behind (fuel : nat) (h : option nat) : list nat :=
  match fuel, h with
  | S fuel, Some h => h :: go_behind fuel (behind h)
  | _, _ => []
  end.

(* Orbit::next: ahead, and from a boundary on behind the first corner. *)
Definition orbit (fuel first : nat) : list nat :=
  let (l, open) := go_ahead fuel first first in
  if open then l ++ go_behind fuel (behind first) else l.

(* The corners from x to z, one turn after another. *)
Inductive path : nat -> list nat -> nat -> Prop :=
| path_one : forall x, path x [x] x
| path_more : forall x y l z, ahead x = Some y -> path y l z -> path x (x :: l) z.

Lemma path_snoc : forall x l y z, path x l y -> ahead y = Some z -> path x (l ++ [z]) z.
Proof.
  induction 1; intros Hz; simpl.
  - eapply path_more; eauto using path.
  - eapply path_more; eauto.
Qed.

Lemma path_head : forall x l y, path x l y -> exists l', l = x :: l'.
Proof. destruct 1; eauto. Qed.

Lemma path_last : forall x l y, path x l y -> exists l', l = l' ++ [y].
Proof.
  induction 1. exists []; auto.
  destruct IHpath as [l' ->]. exists (x :: l'); auto.
Qed.

Lemma path_below : forall x l y, path x l y -> x < N -> forall z, In z l -> z < N.
Proof.
  induction 1; intros Hx w Hw.
  - destruct Hw as [<-|[]]; auto.
  - destruct Hw as [<-|Hw]; auto. apply IHpath; auto. apply (in_range _ _ H).
Qed.

(* What is not the first has one before it; what is not the last has one after it. *)
Lemma path_before : forall x l y, path x l y -> forall z, In z l ->
  z = x \/ exists l1 w l2, l = l1 ++ w :: z :: l2 /\ ahead w = Some z.
Proof.
  induction 1; intros w Hw.
  - destruct Hw as [<-|[]]; auto.
  - destruct Hw as [<-|Hw]; auto. right.
    destruct (IHpath _ Hw) as [->|(l1 & u & l2 & -> & Hu)].
    + destruct (path_head _ _ _ H0) as [l' ->]. exists [], x, l'; auto.
    + exists (x :: l1), u, l2; auto.
Qed.

Lemma path_after : forall x l y, path x l y -> forall z, In z l ->
  z = y \/ exists l1 w l2, l = l1 ++ z :: w :: l2 /\ ahead z = Some w.
Proof.
  induction 1; intros w Hw.
  - destruct Hw as [<-|[]]; auto.
  - destruct Hw as [<-|Hw].
    + right. destruct (path_head _ _ _ H0) as [l' ->]. exists [], y, l'; auto.
    + destruct (IHpath _ Hw) as [->|(l1 & u & l2 & -> & Hu)]; auto.
      right. exists (x :: l1), u, l2; auto.
Qed.

Lemma nodup_below : forall l, NoDup l -> (forall z, In z l -> z < N) -> length l <= N.
Proof.
  intros l Hd Hb. rewrite <- (seq_length N 0). apply NoDup_incl_length; auto.
  intros z Hz. apply in_seq. specialize (Hb z Hz). lia.
Qed.

Lemma nodup_snoc : forall (l : list nat) x, NoDup l -> ~ In x l -> NoDup (l ++ [x]).
Proof.
  intros. apply (Permutation_NoDup (l := x :: l)).
  - apply Permutation_cons_append.
  - constructor; auto.
Qed.

(* Going ahead from the end of a path comes to a new corner, or to the first one. *)
Lemma ahead_is_new_or_first : forall x l y z, path x l y -> NoDup l -> ahead y = Some z -> In z l -> z = x.
Proof.
  intros x l y z Hp Hd Hf Hin.
  destruct (path_before _ _ _ Hp _ Hin) as [->|(l1 & w & l2 & E & Hw)]; auto.
  exfalso. assert (w = y) by (eapply ahead_injective; eauto). subst w.
  destruct (path_last _ _ _ Hp) as [l' El].
  rewrite E in El, Hd.
  assert (In y (z :: l2)).
  { destruct (exists_last (l := z :: l2)) as (m & u & Em); try discriminate.
    rewrite Em in *. replace (l1 ++ y :: m ++ [u]) with ((l1 ++ y :: m) ++ [u]) in El
      by (rewrite <- app_assoc; auto).
    apply app_inj_tail in El. destruct El as [_ ->]. apply in_or_app; right; left; auto. }
  apply NoDup_remove_2 in Hd. apply Hd. apply in_or_app; auto.
Qed.

(* Going behind the start of a path that ends at a boundary comes to a new corner. *)
Lemma behind_is_new : forall x l e w, path x l e -> NoDup l -> ahead e = None -> ahead w = Some x -> ~ In w l.
Proof.
  intros x l e w Hp Hd He Hw Hin.
  destruct (path_after _ _ _ Hp _ Hin) as [->|(l1 & u & l2 & E & Hu)]; [congruence|].
  assert (u = x) by congruence. subst u.
  destruct (path_head _ _ _ Hp) as [l' El]. rewrite El in E. rewrite El in Hd.
  inversion Hd as [|? ? Hx _]; subst. apply Hx.
  destruct l1 as [|a l1]; simpl in E; injection E; intros E2 _; rewrite E2.
  - left; auto.
  - apply in_or_app; right; right; left; auto.
Qed.

Lemma going_ahead_is_a_path : forall fuel first acc h l open,
  first < N -> path first (acc ++ [h]) h -> NoDup (acc ++ [h]) -> N <= fuel + length acc ->
  go_ahead fuel first h = (l, open) ->
  exists e, path first (acc ++ l) e /\ NoDup (acc ++ l) /\ ahead e = if open then None else Some first.
Proof.
  induction fuel; intros first acc h l open Hlt Hp Hd Hfuel Hw.
  - exfalso. pose proof (nodup_below _ Hd (path_below _ _ _ Hp Hlt)) as Hlen.
    rewrite app_length in Hlen. simpl in *. lia.
  - simpl in Hw. destruct (ahead h) as [g|] eqn:Ef.
    + destruct (g =? first) eqn:Eg.
      * apply Nat.eqb_eq in Eg. subst g. injection Hw; intros <- <-. exists h; auto.
      * apply Nat.eqb_neq in Eg. destruct (go_ahead fuel first g) as [l' o'] eqn:Er.
        injection Hw; intros <- <-.
        replace (acc ++ h :: l') with ((acc ++ [h]) ++ l') by (rewrite <- app_assoc; auto).
        eapply IHfuel; eauto.
        -- eapply path_snoc; eauto.
        -- apply nodup_snoc; auto. intros Hin. apply Eg. eapply ahead_is_new_or_first; eauto.
        -- rewrite app_length; simpl; lia.
    + injection Hw; intros <- <-. exists h; auto.
Qed.

Lemma going_behind_extends_a_path : forall fuel x l e,
  x < N -> path x l e -> NoDup l -> ahead e = None -> N <= fuel + length l ->
  exists s, path s (rev (go_behind fuel (behind x)) ++ l) e /\
            NoDup (rev (go_behind fuel (behind x)) ++ l) /\ behind s = None.
Proof.
  induction fuel; intros x l e Hlt Hp Hd He Hfuel; destruct (behind x) as [w|] eqn:Eb; simpl; eauto.
  - exfalso. apply inverse in Eb. assert (Hn : ~ In w l) by (eapply behind_is_new; eauto).
    destruct (in_range _ _ Eb) as [Hw _].
    assert (path w (w :: l) e) as Hp' by (eapply path_more; eauto).
    assert (NoDup (w :: l)) as Hd' by (constructor; auto).
    pose proof (nodup_below _ Hd' (path_below _ _ _ Hp' Hw)) as Hlen. simpl in *. lia.
  - apply inverse in Eb. assert (Hn : ~ In w l) by (eapply behind_is_new; eauto).
    destruct (in_range _ _ Eb) as [Hw _].
    destruct (IHfuel w (w :: l) e) as (s & H1 & H2 & H3); auto.
    + eapply path_more; eauto.
    + constructor; auto.
    + simpl; lia.
    + exists s. rewrite <- app_assoc. auto.
Qed.

(* In one orbit: joined by turns, in either direction. *)
Definition step x y := ahead x = Some y \/ ahead y = Some x.
Definition joined := clos_refl_trans nat step.

Lemma step_sym : forall x y, step x y -> step y x.
Proof. unfold step; tauto. Qed.
Lemma joined_sym : forall x y, joined x y -> joined y x.
Proof.
  induction 1; [apply rt_step, step_sym; auto | apply rt_refl | eapply rt_trans; eauto].
Qed.
Lemma joined_trans : forall x y z, joined x y -> joined y z -> joined x z.
Proof. intros; eapply rt_trans; eauto. Qed.

Lemma joined_below : forall x y, joined x y -> x < N -> y < N.
Proof.
  induction 1; auto. destruct H as [H|H]; apply in_range in H; tauto.
Qed.

Lemma path_joined : forall x l y, path x l y -> forall z, In z l -> joined x z.
Proof.
  induction 1; intros w Hw.
  - destruct Hw as [<-|[]]. apply rt_refl.
  - destruct Hw as [<-|Hw]; [apply rt_refl|].
    eapply rt_trans; [apply rt_step; left; eauto | apply IHpath; auto].
Qed.

Lemma closed_is_all : forall l, (forall x y, In x l -> step x y -> In y l) ->
  forall x y, joined x y -> In x l -> In y l.
Proof. intros l Hc. induction 1; eauto. Qed.

(* The loop lists the orbit of the corner that it starts at, each corner once. *)
Theorem orbit_lists_each_once : forall fuel first, N <= fuel -> first < N ->
  NoDup (orbit fuel first) /\ forall h, In h (orbit fuel first) <-> joined first h.
Proof.
  intros fuel first Hfuel Hlt. unfold orbit.
  destruct (go_ahead fuel first first) as [l open] eqn:Ew.
  destruct (going_ahead_is_a_path fuel first [] first l open) as (e & Hp & Hd & He); auto;
    simpl in *; try lia.
  { constructor. } { repeat constructor; auto. }
  destruct open.
  - (* A path: both ends are boundary. *)
    destruct (going_behind_extends_a_path fuel first l e) as (s & Hp' & Hd' & Hs); auto; try lia.
    set (m := go_behind fuel (behind first)) in *.
    assert (Hperm : Permutation (rev m ++ l) (l ++ m)).
    { rewrite Permutation_app_comm. apply Permutation_app_head. symmetry. apply Permutation_rev. }
    split. { eapply Permutation_NoDup; eauto. }
    intros h. rewrite <- (Permutation_in' (eq_refl h) Hperm).
    assert (Hfirst : In first (rev m ++ l)).
    { destruct (path_head _ _ _ Hp) as [l' ->]. apply in_or_app; right; left; auto. }
    split; intros Hh.
    + eapply joined_trans; [apply joined_sym|]; eapply path_joined; eauto.
    + eapply closed_is_all; eauto. intros x y Hx [Hy|Hy].
      * destruct (path_after _ _ _ Hp' _ Hx) as [->|(l1 & w & l2 & E & Hw)]; [congruence|].
        assert (w = y) by congruence. subst w. rewrite E. apply in_or_app; right; right; left; auto.
      * destruct (path_before _ _ _ Hp' _ Hx) as [->|(l1 & w & l2 & E & Hw)].
        { apply inverse in Hy. congruence. }
        assert (w = y) by (eapply ahead_injective; eauto). subst w. rewrite E. apply in_or_app; right; left; auto.
  - (* A cycle. *)
    split; auto. intros h. split; intros Hh; [eapply path_joined; eauto|].
    assert (Hfirst : In first l) by (destruct (path_head _ _ _ Hp) as [l' ->]; left; auto).
    assert (Hlast : In e l) by (destruct (path_last _ _ _ Hp) as [l' ->]; apply in_or_app; right; left; auto).
    eapply closed_is_all; eauto. intros x y Hx [Hy|Hy].
    + destruct (path_after _ _ _ Hp _ Hx) as [->|(l1 & w & l2 & E & Hw)]; [congruence|].
      assert (w = y) by congruence. subst w. rewrite E. apply in_or_app; right; right; left; auto.
    + destruct (path_before _ _ _ Hp _ Hx) as [->|(l1 & w & l2 & E & Hw)].
      { assert (y = e) by (eapply ahead_injective; eauto). subst; auto. }
      assert (w = y) by (eapply ahead_injective; eauto). subst w. rewrite E. apply in_or_app; right; left; auto.
Qed.

(* With more fuel a loop does the same, or has used all of it. *)
Lemma going_ahead_ends : forall fuel first h, go_ahead (S fuel) first h = go_ahead fuel first h \/
  length (fst (go_ahead (S fuel) first h)) = S fuel.
Proof.
  induction fuel; intros first h.
  - right. simpl. destruct (ahead h) as [g|]; [destruct (g =? first)|]; auto.
  - assert (E : forall k, go_ahead (S k) first h = match ahead h with
      | None => ([h], true)
      | Some g => if g =? first then ([h], false) else let (l, open) := go_ahead k first g in (h :: l, open)
      end) by auto.
    rewrite (E (S fuel)), (E fuel). destruct (ahead h) as [g|]; auto. destruct (g =? first); auto.
    destruct (IHfuel first g) as [->|El]; auto. right. destruct (go_ahead (S fuel) first g). simpl in *. auto.
Qed.
Lemma going_behind_ends : forall fuel h, go_behind (S fuel) h = go_behind fuel h \/
  length (go_behind (S fuel) h) = S fuel.
Proof.
  induction fuel; intros [h|]; auto. destruct (IHfuel (behind h)) as [E|E].
  - left. change (go_behind (S (S fuel)) (Some h)) with (h :: go_behind (S fuel) (behind h)). rewrite E. auto.
  - right. change (S (length (go_behind (S fuel) (behind h))) = S (S fuel)). auto.
Qed.
(* The loop ends by itself: fuel beyond one for each corner is left over. *)
Theorem orbit_ends : forall fuel first, N <= fuel -> first < N -> orbit fuel first = orbit N first.
Proof.
  intros fuel first Hfuel Hlt. induction Hfuel as [|fuel Hfuel IH]; auto. rewrite <- IH. clear IH.
  assert (Hshort : length (orbit (S fuel) first) <= N).
  { destruct (orbit_lists_each_once (S fuel) first) as [Hd Hall]; auto.
    apply nodup_below; auto. intros z Hz. apply Hall in Hz. eapply joined_below; eauto. }
  unfold orbit in *. destruct (going_ahead_ends fuel first first) as [E|E].
  - rewrite E in *. destruct (go_ahead fuel first first) as [l [|]]; auto.
    destruct (going_behind_ends fuel (behind first)) as [->|El]; auto. rewrite app_length in Hshort. lia.
  - destruct (go_ahead (S fuel) first first) as [l [|]]; simpl in E; rewrite ?app_length in Hshort; lia.
Qed.

End Walk.
