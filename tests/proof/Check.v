(* A checker of states, and its proof: a state that it accepts is well-formed, however it came about.

   It gets the state, and a witness of which corners have the same root, made in any way: a bad witness can make it
   refuse, and never accept. It passes over the half-edges once, and looks at a few others from each; that this takes
   linear time is not a theorem. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State Split Merge.
Import ListNotations.

Record witness := Witness {
  root : nat -> nat;                       (* one corner for all that have the same root *)
  turns : nat -> nat;                      (* how many turns it is away *)
  edge_from : nat -> nat -> option nat;    (* the half-edge between two roots *)
  root_of : nat -> nat                     (* the root of a vertex *)
}.

(* A state of which nothing is known beyond its half-edges. *)
Definition within S := Mesh (faces S)
  (fun h => if h <? size S then link S h else None) (fun h => (h <? size S) && torn S h) (origin S) (vertices S).

Section Check.
Variable S : mesh.
Variable w : witness.
Let n := size S.
Let lk := link S.
Definition is g (h : option nat) := match h with Some k => k =? g | None => false end.

Definition check_link h := match lk h with
  | None => negb (torn S h)
  | Some g => (g <? n) && is h (lk g) && negb (face h =? face g) &&                           (* I2, I4 *)
      eqb (torn S h) (torn S g) && eqb (torn S h) (negb (agree lk (origin S) h)) &&           (* I5, I6, I7 *)
      (root w h =? root w (next g)) && negb (root w (prev h) =? root w (prev g))              (* I13 *)
  end.
Definition nearer h g := match g with Some g => (root w g =? root w h) && (turns w g <? turns w h) | None => false end.
Definition check_root h :=
  ((root w h =? h) || nearer h (lk (prev h)) || nearer h (option_map next (lk h))) &&
  negb (root w h =? root w (next h)) &&                                                       (* I3 *)
  is h (edge_from w (root w h) (root w (next h))) &&                                          (* I11 *)
  match edge_from w (root w (next h)) (root w h) with Some g => is g (lk h) | None => true end. (* I12 *)
Definition check_label h := (origin S h <? vertices S) && (root_of w (origin S h) =? root w h). (* I2, I8 *)
Definition check_all := forallb (fun h => check_link h && check_root h && check_label h) (seq 0 n).

Hypothesis outside : forall h, n <= h -> lk h = None /\ torn S h = false.
Hypothesis accepted : check_all = true.

Lemma is_some : forall g h, is g h = true -> h = Some g.
Proof. intros g [k|] H; simpl in H; [apply Nat.eqb_eq in H; congruence|discriminate]. Qed.
Lemma each : forall h, h < n -> check_link h = true /\ check_root h = true /\ check_label h = true.
Proof.
  intros h Hh. unfold check_all in accepted. rewrite forallb_forall in accepted.
  assert (Hc : In h (seq 0 n)) by (apply in_seq; lia). apply accepted in Hc. rewrite !andb_true_iff in Hc. tauto.
Qed.
Lemma inside : forall h g, lk h = Some g -> h < n.
Proof. intros h g E. destruct (le_lt_dec n h) as [H|H]; auto. apply outside in H. destruct H; congruence. Qed.

Lemma links : forall h g, lk h = Some g ->
  h < n /\ g < n /\ lk g = Some h /\ face h <> face g /\ torn S h = torn S g /\
  torn S h = negb (agree lk (origin S) h) /\ root w h = root w (next g) /\ root w (prev h) <> root w (prev g).
Proof.
  intros h g E. pose proof (inside _ _ E) as Hh. destruct (each _ Hh) as [Hp _]. unfold check_link in Hp.
  rewrite E, !andb_true_iff, !negb_true_iff, !Nat.eqb_neq, Nat.ltb_lt, Nat.eqb_eq in Hp.
  destruct Hp as [[[[[[H1 H2] H3] H4] H5] H6] H7]. apply eqb_prop in H4, H5. apply is_some in H2. repeat split; auto.
Qed.
Lemma turn_keeps_root : forall h g, lk (prev h) = Some g -> root w h = root w g.
Proof.
  intros h g E. apply links in E. destruct E as (_ & _ & E & _). apply links in E.
  destruct E as (_ & _ & _ & _ & _ & _ & E & _). rewrite next_prev in E. auto.
Qed.
Lemma joined_to_root : forall k h, h < n -> turns w h < k -> same_root lk h (root w h).
Proof.
  induction k; [lia|]. intros h Hh Hk. destruct (each _ Hh) as [_ [Hr _]]. unfold check_root in Hr.
  rewrite !andb_true_iff, !orb_true_iff in Hr. destruct Hr as [[[[[Hr|Hr]|Hr] _] _] _].
  - apply Nat.eqb_eq in Hr. rewrite Hr. apply rt_refl.
  - destruct (lk (prev h)) as [g|] eqn:E; simpl in Hr; [|discriminate].
    rewrite andb_true_iff, Nat.eqb_eq, Nat.ltb_lt in Hr. destruct Hr as [Hr Ht]. rewrite <- Hr.
    eapply joined_trans; [apply rt_step; left; exact E|]. apply IHk; [|lia]. apply links in E. tauto.
  - destruct (lk h) as [g|] eqn:E; simpl in Hr; [|discriminate].
    rewrite andb_true_iff, Nat.eqb_eq, Nat.ltb_lt in Hr. destruct Hr as [Hr Ht]. rewrite <- Hr.
    apply links in E. destruct E as (_ & Hg & E & _).
    eapply joined_trans; [apply rt_step; right; rewrite prev_next; exact E|].
    apply IHk; [|lia]. apply next_below; auto.
Qed.
Lemma same_root_is_root : forall h g, h < n -> g < n -> (same_root lk h g <-> root w h = root w g).
Proof.
  intros h g Hh Hg. split.
  - unfold same_root, joined. clear Hh Hg.
    induction 1 as [x y [E|E]| |]; [apply turn_keeps_root; auto|symmetry; apply turn_keeps_root; auto|auto|congruence].
  - intros E. eapply joined_trans; [eapply joined_to_root; eauto|].
    rewrite E. apply joined_sym. eapply joined_to_root; eauto.
Qed.

Lemma roots : forall h, h < n ->
  root w h <> root w (next h) /\ edge_from w (root w h) (root w (next h)) = Some h /\
  (forall g, edge_from w (root w (next h)) (root w h) = Some g -> lk h = Some g).
Proof.
  intros h Hh. destruct (each _ Hh) as [_ [Hr _]]. unfold check_root in Hr.
  rewrite !andb_true_iff, negb_true_iff, Nat.eqb_neq in Hr. destruct Hr as [[[_ H1] H2] H3].
  apply is_some in H2. repeat split; auto. intros g E. rewrite E in H3. apply is_some; auto.
Qed.

Lemma accepted_is_well_formed : well_formed S.
Proof.
  assert (Hn : forall h, h < n -> next h < n) by (intros; apply next_below; auto).
  assert (Hp : forall h, h < n -> prev h < n) by (intros; apply prev_below; auto).
  constructor.
  - constructor; try (intros h g E; apply links in E; tauto).
    + intros h Hh E. apply same_root_is_root in E; auto. apply (roots h); auto.
    + intros h g Hh Hg E1 E2. apply same_root_is_root in E1, E2; auto.
      destruct (roots h Hh) as (_ & E & _). destruct (roots g Hg) as (_ & E' & _). congruence.
    + intros h g Hh Hg E1 E2. apply same_root_is_root in E1, E2; auto.
      apply (roots h Hh). rewrite E1, E2. apply (roots g); auto.
    + intros h g Hh Hg E1 E2 E3. apply same_root_is_root in E1, E2, E3; auto.
      assert (E : lk h = Some (prev g)).
      { apply (roots h Hh). rewrite E1, E2. rewrite <- (next_prev g) at 2. apply (roots (prev g)); auto. }
      apply links in E. destruct E as (_ & _ & _ & _ & _ & _ & _ & E). apply E. rewrite E3. f_equal.
      corner g; rewrite ?prev0, ?prev1, ?prev2; auto.
  - intros h Hh. destruct (each _ Hh) as (_ & _ & Hl). unfold check_label in Hl.
    apply andb_true_iff in Hl. apply Nat.ltb_lt. tauto.
  - intros h g E. apply links in E. tauto.
  - intros h E. destruct (le_lt_dec n h) as [H|H]; [apply outside; auto|].
    destruct (each _ H) as [Hl _]. unfold check_link in Hl. fold lk in E. rewrite E in Hl. apply negb_true_iff; auto.
  - intros h g E. pose proof (links _ _ E) as (_ & _ & _ & _ & _ & Ht & _). rewrite Ht, negb_false_iff.
    unfold agree. fold lk in E. rewrite E, andb_true_iff, !Nat.eqb_eq. tauto.
  - intros h g Hh Hg E. apply same_root_is_root; auto.
    destruct (each _ Hh) as (_ & _ & H1). destruct (each _ Hg) as (_ & _ & H2). unfold check_label in H1, H2.
    rewrite andb_true_iff, Nat.eqb_eq in H1, H2. destruct H1 as [_ <-], H2 as [_ <-]. congruence.
Qed.
End Check.

Definition check S w := check_all (within S) w.
Theorem what_the_checker_accepts_is_well_formed : forall S w, check S w = true -> well_formed (within S).
Proof.
  intros S w. apply accepted_is_well_formed. intros h Hh. unfold within, size in *. simpl in *.
  apply Nat.ltb_ge in Hh. rewrite Hh. auto.
Qed.

(* A witness that needs no help, for small states: the smallest corner of each orbit, and the places in its walk. *)
Definition orbit_of S h := orbit (ahead S) (behind S) (size S) h.
Fixpoint place (h : nat) (l : list nat) := match l with [] => 0 | x :: l => if x =? h then 0 else 1 + place h l end.
Definition smallest S h := fold_right Nat.min h (orbit_of S h).
Definition witness_of S := Witness
  (smallest S)
  (fun h => place h (orbit_of S (smallest S h)))
  (fun a b => find (fun h => (smallest S h =? a) && (smallest S (next h) =? b)) (seq 0 (size S)))
  (fun v => match half_edge_of S v with Some h => smallest S h | None => 0 end).
