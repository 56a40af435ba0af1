(* The insertion of a vertex, whether in a face or on an edge: a cone over an outline.

   Each face that is divided is replaced by triangles that join the new vertex to old half-edges. Those half-edges, in
   their order round the new vertex, are the *outline*: the three of a face, or what is left of the two faces of an edge
   when the edge itself is taken out. This file proves of any outline, and any numbering of the new triangles, that a
   well-formed mesh stays well-formed. Insert.v has the two outlines. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State Split.
Import ListNotations.

(* A half-edge of the new mesh: one of a face that is not divided; or of the triangle over a half-edge w of the outline:
   w itself, back from its end to the new vertex, or forth from there to its origin. *)
Inductive part := Rest (p : nat) | Edge (w : nat) | Back (w : nat) | Forth (w : nat).

(* An insertion: the outline, who follows whom on it, the half-edge Forth of each triangle, and how many faces there
   are. On a torn edge the new vertex is two, and the link from Back w to the triangle that follows is `cut`. *)
Record cone := Cone {
  outline : list nat; succ : nat -> option nat; pred : nat -> option nat;
  forth : nat -> nat; faces_then : nat; cut : nat -> bool; second : nat -> bool }.

Section Build.
Variables (S : mesh) (c : cone).
Let n' := 3 * faces_then c.
Definition kept q := if mem q (outline c) then Edge q else Rest q.
Definition number k := match k with
  | Rest p => p | Edge w => next (forth c w) | Back w => prev (forth c w) | Forth w => forth c w end.
Definition part_of x := match find (fun w => face (forth c w) =? face x) (outline c) with
  | None => Rest x
  | Some w => if x =? forth c w then Forth w else if x =? next (forth c w) then Edge w else Back w end.
Definition part_link k := match k with
  | Rest p | Edge p => option_map kept (link S p)
  | Back w => option_map Forth (succ c w)
  | Forth w => option_map Back (pred c w) end.
Definition part_torn k := match k with
  | Rest p | Edge p => torn S p
  | Back w => cut c w
  | Forth w => match pred c w with Some u => cut c u | None => false end end.
Definition new_vertex w := if second c w then 1 + vertices S else vertices S.
Definition part_origin k := match k with
  | Rest p | Edge p => origin S p | Back w => origin S (next w) | Forth w => new_vertex w end.
Definition insert : mesh := Mesh (faces_then c)
  (fun x => if x <? n' then option_map number (part_link (part_of x)) else None)
  (fun x => (x <? n') && part_torn (part_of x))
  (fun x => part_origin (part_of x))
  (if existsb (second c) (outline c) then 2 + vertices S else 1 + vertices S).
End Build.

Section Proof.
Variables (S : mesh) (c : cone) (first : nat).
Hypothesis W : well_formed S.
Let M := is_manifold S W.
Let lk := link S.
Let On w := In w (outline c).
Definition divided p := exists w, On w /\ face w = face p.

(* What makes an outline. *)
Record outlined : Prop := {
  on_mesh : forall w, On w -> w < size S;
  (* Of a divided face at most one half-edge is taken out. *)
  off_outline : forall p, divided p -> ~ On p -> On (prev p) /\ On (next p);
  (* One half-edge begins where the one that it follows ends; each that can follow does. *)
  follows : forall w u, succ c w = Some u -> On w /\ On u /\ same_root lk (next w) u;
  precedes : forall w u, succ c w = Some u <-> pred c u = Some w;
  follows_if_it_can : forall w u, On w -> On u -> same_root lk (next w) u -> succ c w = Some u;
  (* The outline does not touch itself. *)
  starts_differ : forall w u, On w -> On u -> same_root lk w u -> w = u;
  ends_differ : forall w u, On w -> On u -> same_root lk (next w) (next u) -> w = u;
  no_two_follow_each_other : forall w u, succ c w = Some u -> succ c u = Some w -> False;
  (* The other half-edge of the edge that is taken out is so too; the outline goes on across it, cut if it was torn. *)
  gap : forall p q, divided p -> ~ On p -> lk p = Some q ->
    divided q /\ ~ On q /\ succ c (prev q) = Some (next p) /\ cut c (prev q) = torn S q;
  gap_on_boundary : forall p, divided p -> ~ On p -> lk p = None -> succ c (prev p) = None /\ pred c (next p) = None;
  in_one_piece : On first /\ forall w, On w -> joined (succ c) first w;
  (* The new triangles have new numbers, or that of the face that they are in, and all of these. *)
  triangles_differ : forall w u, On w -> On u -> face (forth c w) = face (forth c u) -> w = u;
  triangle_in_place : forall w, On w ->
    forth c w < 3 * faces_then c /\ (forth c w < size S -> face (forth c w) = face w);
  faces_stay : forall x, x < 3 * faces_then c ->
    (exists w, On w /\ face (forth c w) = face x) \/ (x < size S /\ ~ divided x);
  no_face_goes : faces S <= faces_then c;
  (* A link round the new vertex is cut if its ends differ, and only then. *)
  one_point_in_a_face : forall w u, On w -> On u -> face w = face u -> second c w = second c u;
  cut_follows : forall w, succ c w = None -> cut c w = false;
  cut_if_apart : forall w u, succ c w = Some u ->
    (cut c w = false <-> origin S (next w) = origin S u /\ new_vertex S c w = new_vertex S c u)
}.
Hypothesis O : outlined.

Inductive valid : part -> Prop :=
| valid_rest : forall p, p < size S -> ~ divided p -> valid (Rest p)
| valid_edge : forall w, On w -> valid (Edge w)
| valid_back : forall w, On w -> valid (Back w)
| valid_forth : forall w, On w -> valid (Forth w).
Definition next_part k := match k with
  | Rest p => Rest (next p) | Edge w => Back w | Back w => Forth w | Forth w => Edge w end.
Definition prev_part k := match k with
  | Rest p => Rest (prev p) | Edge w => Forth w | Back w => Edge w | Forth w => Back w end.
(* The old corner whose vertex a corner has; none for the new vertex. *)
Definition label k := match k with Rest p | Edge p => Some p | Back w => Some (next w) | Forth _ => None end.
Definition alike (a b : option nat) := match a, b with
  | None, None => True | Some p, Some q => same_root lk p q | _, _ => False end.

Lemma face_next : forall h, face (next h) = face h.
Proof.
  intros h. unfold face. corner h;
    rewrite ?(Nat.mul_comm 3), ?Nat.div_add_l, ?Nat.div_mul by lia; simpl; auto; rewrite <- ?Nat.add_assoc; auto.
Qed.
Lemma face_prev : forall h, face (prev h) = face h.
Proof. intros h. rewrite <- (face_next (prev h)), next_prev. auto. Qed.
Lemma next_next : forall h, next (next h) = prev h.
Proof. intros h. corner h; rewrite ?next0, ?next1, ?next2; auto. Qed.
Lemma prev_prev : forall h, prev (prev h) = next h.
Proof. intros h. rewrite <- (next_next h), prev_next. auto. Qed.
Lemma next_differs : forall h, next h <> h.
Proof. intros h. corner h; lia. Qed.
Lemma prev_differs : forall h, prev h <> h.
Proof. intros h. corner h; lia. Qed.
Lemma next_is_not_prev : forall h, next h <> prev h.
Proof. intros h. corner h; lia. Qed.
Lemma of_one_face : forall h g, face h = face g -> g = h \/ g = next h \/ g = prev h.
Proof.
  intros h g E. unfold face in E. destruct (corner_form h) as (q & Hq), (corner_form g) as (r & Hr).
  assert (Hf : forall k m, k = 3 * m \/ k = 3 * m + 1 \/ k = 3 * m + 2 -> k / 3 = m).
  { intros k m H. symmetry. apply (Nat.div_unique k 3 m (k - 3 * m)); lia. }
  rewrite (Hf _ _ Hq), (Hf _ _ Hr) in E. subst r.
  destruct Hq as [ ->|[ ->| ->]]; rewrite ?next0, ?next1, ?next2, ?prev0, ?prev1, ?prev2; lia.
Qed.
Lemma divided_next : forall p, divided (next p) <-> divided p.
Proof. intros p. unfold divided. rewrite face_next. tauto. Qed.
Lemma divided_prev : forall p, divided (prev p) <-> divided p.
Proof. intros p. unfold divided. rewrite face_prev. tauto. Qed.
Lemma on_divided : forall w, On w -> divided w.
Proof. intros w H. exists w. auto. Qed.
Lemma on_dec : forall w, On w \/ ~ On w.
Proof. intros w. destruct (in_dec Nat.eq_dec w (outline c)); auto. Qed.
Lemma classic_divided : forall p, divided p \/ ~ divided p.
Proof.
  intros p. destruct (existsb (fun w => face w =? face p) (outline c)) eqn:E.
  - left. apply existsb_exists in E. destruct E as (w & Hw & E). apply Nat.eqb_eq in E. exists w. auto.
  - right. intros (w & Hw & Ew). assert (Ht : existsb (fun w => face w =? face p) (outline c) = true); [|congruence].
    apply existsb_exists. exists w. rewrite Ew, Nat.eqb_refl. auto.
Qed.
Lemma mem_spec : forall w, mem w (outline c) = true <-> On w.
Proof. intros. apply mem_in. Qed.
Lemma not_mem : forall w, ~ On w -> mem w (outline c) = false.
Proof. intros w H. apply not_true_is_false. rewrite mem_spec. auto. Qed.

(* ---- the numbering ---- *)
Lemma rest_is_nowhere_else : forall p w, p < size S -> ~ divided p -> On w -> face (forth c w) <> face p.
Proof.
  intros p w Hp Hd Hw E. apply Hd. destruct (triangle_in_place O w Hw) as [_ Ht]. exists w. split; auto.
  rewrite <- E, Ht; auto.
  destruct (of_one_face _ _ (eq_sym E)) as [ ->|[ ->| ->]]; auto; [apply next_below|apply prev_below]; auto.
Qed.
Lemma found : forall w x, On w -> face (forth c w) = face x ->
  find (fun w => face (forth c w) =? face x) (outline c) = Some w.
Proof.
  intros w x Hw E. destruct (find _ (outline c)) as [u|] eqn:Ef.
  - apply find_some in Ef. destruct Ef as [Hu Eu]. apply Nat.eqb_eq in Eu. f_equal.
    apply (triangles_differ O); auto. congruence.
  - pose proof (find_none _ _ Ef w Hw) as H. simpl in H. apply Nat.eqb_neq in H. congruence.
Qed.
Lemma part_of_number : forall k, valid k -> part_of c (number c k) = k.
Proof.
  intros k Hk. unfold part_of. destruct Hk as [p Hp Hd|w Hw|w Hw|w Hw]; simpl.
  - destruct (find _ (outline c)) as [u|] eqn:Ef; auto. apply find_some in Ef. destruct Ef as [Hu Eu].
    apply Nat.eqb_eq in Eu. exfalso. eapply rest_is_nowhere_else; eauto.
  - rewrite (found w); [|auto|symmetry; apply face_next].
    rewrite Nat.eqb_refl. pose proof (next_differs (forth c w)) as H. apply Nat.eqb_neq in H. rewrite H. auto.
  - rewrite (found w); [|auto|symmetry; apply face_prev].
    pose proof (prev_differs (forth c w)) as H. apply Nat.eqb_neq in H. rewrite H.
    pose proof (next_is_not_prev (forth c w)) as H'. rewrite Nat.eqb_sym. apply Nat.eqb_neq in H'. rewrite H'. auto.
  - rewrite (found w); [|auto|auto]. rewrite Nat.eqb_refl. auto.
Qed.
Lemma number_below : forall k, valid k -> number c k < 3 * faces_then c.
Proof.
  intros k Hk. pose proof (no_face_goes O) as Hf. destruct Hk as [p Hp Hd|w Hw|w Hw|w Hw]; simpl.
  - unfold size in Hp. lia.
  - apply next_below, (triangle_in_place O); auto.
  - apply prev_below, (triangle_in_place O); auto.
  - apply (triangle_in_place O); auto.
Qed.
Lemma numbered : forall x, x < 3 * faces_then c -> exists k, valid k /\ x = number c k.
Proof.
  intros x Hx. destruct (faces_stay O x Hx) as [(w & Hw & E)|[Hs Hd]].
  - destruct (of_one_face _ _ E) as [ ->|[ ->| ->]];
      [exists (Forth w)|exists (Edge w)|exists (Back w)]; split; auto using valid.
  - exists (Rest x). split; auto using valid.
Qed.
Lemma number_injective : forall k j, valid k -> valid j -> number c k = number c j -> k = j.
Proof. intros k j Hk Hj E. apply part_of_number in Hk, Hj. congruence. Qed.
Lemma next_number : forall k, next (number c k) = number c (next_part k).
Proof. intros [p|w|w|w]; simpl; auto using next_prev. rewrite next_next. auto. Qed.
Lemma prev_number : forall k, prev (number c k) = number c (prev_part k).
Proof. intros [p|w|w|w]; simpl; auto using prev_next. rewrite prev_prev. auto. Qed.
Lemma next_valid : forall k, valid k -> valid (next_part k).
Proof.
  intros k [p Hp Hd|w Hw|w Hw|w Hw]; simpl; auto using valid.
  constructor; [apply next_below; auto|rewrite divided_next; auto].
Qed.
Lemma prev_valid : forall k, valid k -> valid (prev_part k).
Proof.
  intros k [p Hp Hd|w Hw|w Hw|w Hw]; simpl; auto using valid.
  constructor; [apply prev_below; auto|rewrite divided_prev; auto].
Qed.

(* ---- the links ---- *)
Lemma kept_valid : forall p q, (divided p -> On p) -> lk p = Some q -> valid (kept c q).
Proof.
  intros p q Hp E. unfold kept. destruct (on_dec q) as [Hq|Hq].
  - rewrite (proj2 (mem_spec q)); auto using valid.
  - rewrite not_mem by auto. constructor; [apply (link_in_range _ _ M _ _ E)|].
    intros Hd. pose proof (link_is_involution _ _ M _ _ E) as E'.
    destruct (gap O _ _ Hd Hq E') as (H1 & H2 & _). auto.
Qed.
Lemma part_link_kept : forall p, part_link S c (kept c p) = option_map (kept c) (lk p).
Proof. intros p. unfold kept at 1. destruct (mem p (outline c)); auto. Qed.
Lemma kept_itself : forall k p, valid k -> k = Rest p \/ k = Edge p -> kept c p = k /\ (divided p -> On p).
Proof.
  intros k p Hk [ ->| ->]; inversion Hk; subst; unfold kept.
  - assert (~ On p) by (intros H; apply H1, on_divided; auto). rewrite not_mem by auto. split; auto. tauto.
  - rewrite (proj2 (mem_spec p)); auto.
Qed.
Lemma part_link_involution : forall k j, valid k -> part_link S c k = Some j -> valid j /\ part_link S c j = Some k.
Proof.
  intros k j Hk E.
  assert (Hold : forall p, k = Rest p \/ k = Edge p -> option_map (kept c) (lk p) = Some j ->
                 valid j /\ part_link S c j = Some k).
  { intros p Hp E1. destruct (kept_itself _ _ Hk Hp) as [Ek Hd].
    destruct (lk p) as [q|] eqn:Eq; [|discriminate]. injection E1 as <-. split; [eapply kept_valid; eauto|].
    pose proof (link_is_involution _ _ M _ _ Eq) as E'. fold lk in E'. rewrite part_link_kept, E'. simpl. congruence. }
  destruct Hk as [p Hp Hd|w Hw|w Hw|w Hw]; simpl in E; eauto.
  - destruct (succ c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-.
    destruct (follows O _ _ Eu) as (_ & Hu & _). split; auto using valid. simpl.
    apply (precedes O) in Eu. rewrite Eu. auto.
  - destruct (pred c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-. apply (precedes O) in Eu.
    destruct (follows O _ _ Eu) as (Hu & _ & _). split; auto using valid. simpl. rewrite Eu. auto.
Qed.
Let S' := insert S c.
Let lk' := link S'.
Lemma link_number : forall k, valid k -> lk' (number c k) = option_map (number c) (part_link S c k).
Proof.
  intros k Hk. unfold lk', S', insert. cbn [link]. rewrite (proj2 (Nat.ltb_lt _ _) (number_below k Hk)), part_of_number; auto.
Qed.
Lemma link_inside : forall x y, lk' x = Some y ->
  exists k j, valid k /\ valid j /\ x = number c k /\ y = number c j /\ part_link S c k = Some j.
Proof.
  intros x y E. unfold lk', S', insert in E. cbn [link] in E. destruct (x <? _) eqn:Ex; [|discriminate]. apply Nat.ltb_lt in Ex.
  destruct (numbered x Ex) as (k & Hk & ->). rewrite part_of_number in E by auto.
  destruct (part_link S c k) as [j|] eqn:Ej; [|discriminate]. injection E as <-.
  exists k, j. repeat split; auto. eapply part_link_involution; eauto.
Qed.

(* ---- the roots ---- *)
Definition together k j := same_root lk' (number c k) (number c j).
Lemma turn : forall k j, valid k -> part_link S c (prev_part k) = Some j -> together k j.
Proof.
  intros k j Hk E. apply rt_step. left. rewrite prev_number, link_number, E; auto using prev_valid.
Qed.
Lemma together_sym : forall k j, together k j -> together j k.
Proof. intros. apply joined_sym. auto. Qed.
Lemma together_trans : forall k j i, together k j -> together j i -> together k i.
Proof. intros. eapply joined_trans; eauto. Qed.

(* One corner for all that continue an old one. *)
Definition keep p := if mem p (outline c) then Edge p
  else if mem (prev p) (outline c) then Back (prev p) else Rest p.
Lemma keep_on : forall p, On p -> keep p = Edge p.
Proof. intros p H. unfold keep. rewrite (proj2 (mem_spec p)); auto. Qed.
Lemma keep_gap : forall p, ~ On p -> On (prev p) -> keep p = Back (prev p).
Proof. intros p H H'. unfold keep. rewrite not_mem, (proj2 (mem_spec _)); auto. Qed.
Lemma keep_rest : forall p, ~ divided p -> keep p = Rest p.
Proof.
  intros p H. unfold keep. rewrite !not_mem; auto; intros H'; apply on_divided in H'.
  - rewrite divided_prev in H'. auto. - auto.
Qed.
Lemma keep_valid : forall p, p < size S -> valid (keep p).
Proof.
  intros p Hp. unfold keep. destruct (mem p _) eqn:E1; [apply mem_spec in E1; auto using valid|].
  destruct (mem (prev p) _) eqn:E2; [apply mem_spec in E2; auto using valid|].
  constructor; auto. intros Hd. assert (~ On p) as Hn by (rewrite <- mem_spec; congruence).
  destruct (off_outline O _ Hd Hn) as [H _]. apply mem_spec in H. congruence.
Qed.
Lemma back_is_keep : forall w, On w -> together (Back w) (keep (next w)).
Proof.
  intros w Hw. destruct (on_dec (next w)) as [Hn|Hn].
  - rewrite keep_on by auto. apply together_sym, turn; [constructor; auto|]. simpl.
    assert (E : succ c w = Some (next w)) by (apply (follows_if_it_can O); auto; apply rt_refl).
    apply (precedes O) in E. rewrite E. auto.
  - rewrite keep_gap by (rewrite ?prev_next; auto). rewrite prev_next. apply rt_refl.
Qed.
Lemma label_is_keep : forall k p, valid k -> label k = Some p -> p < size S /\ together k (keep p).
Proof.
  intros k p [q Hq Hd|w Hw|w Hw|w Hw] E; simpl in E; try discriminate; injection E as <-.
  - rewrite keep_rest by auto. split; auto. apply rt_refl.
  - rewrite keep_on by auto. split; [apply (on_mesh O); auto|apply rt_refl].
  - split; [apply next_below, (on_mesh O); auto|apply back_is_keep; auto].
Qed.
Lemma turn_keeps : forall p q, lk (prev p) = Some q -> together (keep p) (keep q).
Proof.
  intros p q E. destruct (link_in_range _ _ M _ _ E) as [Hp Hq].
  assert (Hp' : p < size S) by (rewrite <- (next_prev p); apply next_below; auto).
  destruct (on_dec (prev p)) as [Hu|Hu].
  - apply together_trans with (Back (prev p)).
    { apply together_sym. rewrite <- (next_prev p) at 2. apply back_is_keep; auto. }
    apply together_trans with (kept c q).
    { apply turn; [constructor; auto|]. simpl. fold lk. rewrite E. auto. }
    unfold kept. destruct (mem q _) eqn:Em.
    + apply mem_spec in Em. rewrite keep_on by auto. apply rt_refl.
    + assert (Hn : ~ On q) by (rewrite <- mem_spec; congruence).
      rewrite keep_rest; [apply rt_refl|]. intros Hd. pose proof (link_is_involution _ _ M _ _ E) as E'.
      destruct (gap O _ _ Hd Hn E') as (_ & H & _). auto.
  - destruct (classic_divided (prev p)) as [Hd|Hd].
    + destruct (gap O _ _ Hd Hu E) as (Hdq & Hnq & Es & _). rewrite next_prev in Es.
      destruct (off_outline O _ Hdq Hnq) as [Hq' _]. destruct (follows O _ _ Es) as (_ & Hop & _).
      rewrite keep_on, keep_gap by auto. apply turn; [constructor; auto|]. simpl.
      apply (precedes O) in Es. rewrite Es. auto.
    + rewrite keep_rest by (rewrite <- divided_prev; auto).
      apply together_trans with (kept c q).
      { apply turn; [constructor; auto; rewrite <- divided_prev; auto|]. simpl. fold lk. rewrite E. auto. }
      unfold kept. destruct (mem q _) eqn:Em.
      * apply mem_spec in Em. rewrite keep_on by auto. apply rt_refl.
      * assert (Hn : ~ On q) by (rewrite <- mem_spec; congruence).
        rewrite keep_rest; [apply rt_refl|]. intros Hd'. pose proof (link_is_involution _ _ M _ _ E) as E'.
        destruct (gap O _ _ Hd' Hn E') as (H & _ & _). auto.
Qed.
Lemma alike_sym : forall a b, alike a b -> alike b a.
Proof. intros [p|] [q|]; simpl; auto. apply joined_sym. Qed.
Lemma alike_trans : forall a b d, alike a b -> alike b d -> alike a d.
Proof. intros [p|] [q|] [r|]; simpl; try tauto. apply joined_trans. Qed.
Lemma turn_is_alike : forall k j, part_link S c (prev_part k) = Some j -> alike (label k) (label j).
Proof.
  assert (Hk : forall q, label (kept c q) = Some q) by (intros q; unfold kept; destruct (mem q _); auto).
  intros [p|w|w|w] j E; simpl in E.
  - destruct (link S (prev p)) as [q|] eqn:Eq; [|discriminate]. injection E as <-. rewrite Hk. apply rt_step. left. auto.
  - destruct (pred c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-. apply (precedes O) in Eu.
    apply joined_sym. apply (follows O); auto.
  - destruct (link S w) as [q|] eqn:Eq; [|discriminate]. injection E as <-. rewrite Hk. apply rt_step. left.
    unfold lk. rewrite prev_next. auto.
  - destruct (succ c w); [|discriminate]. injection E as <-. simpl. auto.
Qed.
Lemma joined_is_alike : forall x y, same_root lk' x y -> forall k, valid k -> x = number c k ->
  exists j, valid j /\ y = number c j /\ alike (label k) (label j).
Proof.
  induction 1 as [x y [E|E]|x|x y z _ IH1 _ IH2]; intros k Hk ->.
  - apply link_inside in E. destruct E as (i & j & Hi & Hj & E1 & -> & E2). rewrite prev_number in E1.
    apply number_injective in E1; auto using prev_valid. subst i. exists j. auto using turn_is_alike.
  - apply link_inside in E. destruct E as (i & j & Hi & Hj & E1 & E2 & E3). apply number_injective in E2; auto. subst j.
    exists (next_part i). split; [apply next_valid; auto|]. split; [rewrite <- next_number, <- E1, next_prev; auto|].
    apply alike_sym, turn_is_alike. destruct i; simpl in *; auto. rewrite prev_next. auto.
  - exists k. split; auto. split; auto. destruct (label k); simpl; auto. apply rt_refl.
  - destruct (IH1 k Hk eq_refl) as (j & Hj & -> & A). destruct (IH2 j Hj eq_refl) as (i & Hi & E & B).
    exists i. split; auto. split; auto. eapply alike_trans; eauto.
Qed.
Lemma forths_together : forall w u, joined (succ c) w u -> together (Forth w) (Forth u).
Proof.
  induction 1 as [x y [E|E]|x|x y z _ IH1 _ IH2]; [|apply together_sym|apply rt_refl|eapply together_trans; eauto];
    destruct (follows O _ _ E) as (H & _ & _); (apply turn; [constructor; auto|]); simpl; rewrite E; auto.
Qed.
Lemma keeps_together : forall p q, same_root lk p q -> together (keep p) (keep q).
Proof.
  induction 1 as [x y [E|E]|x|x y z _ IH1 _ IH2];
    [apply turn_keeps|apply together_sym, turn_keeps|apply rt_refl|eapply together_trans]; eauto.
Qed.
(* Two corners have the same root now if what they continue had, or if both are at the new vertex. *)
Lemma same_root_now : forall k j, valid k -> valid j ->
  (same_root lk' (number c k) (number c j) <-> alike (label k) (label j)).
Proof.
  intros k j Hk Hj. split; intros H.
  - destruct (joined_is_alike _ _ H k Hk eq_refl) as (i & Hi & E & A). apply number_injective in E; auto. congruence.
  - destruct (label k) as [p|] eqn:Ek, (label j) as [q|] eqn:Ej; try contradiction.
    + apply label_is_keep in Ek, Ej; auto. destruct Ek as [_ Ek], Ej as [_ Ej].
      eapply together_trans; [exact Ek|]. eapply together_trans; [apply keeps_together; exact H|].
      apply together_sym; auto.
    + destruct k as [p|w|w|w]; try discriminate. destruct j as [q|u|u|u]; try discriminate.
      inversion Hk; inversion Hj; subst. destruct (in_one_piece O) as [_ Hall].
      eapply together_trans; [apply together_sym|]; apply forths_together; auto.
Qed.

Lemma kept_is_rest : forall q p, kept c q = Rest p -> q = p.
Proof. intros q p. unfold kept. destruct (mem q _); congruence. Qed.
Lemma kept_is_edge : forall q w, kept c q = Edge w -> q = w.
Proof. intros q w. unfold kept. destruct (mem q _); congruence. Qed.
Lemma no_part_links_its_face : forall k j, valid k -> part_link S c k = Some j ->
  j <> k /\ j <> next_part k /\ j <> prev_part k.
Proof.
  assert (Hold : forall p q, lk p = Some q -> q <> p /\ q <> next p /\ q <> prev p).
  { intros p q E. pose proof (link_leaves_face _ _ M _ _ E) as H.
    repeat split; intros ->; apply H; rewrite ?face_next, ?face_prev; auto. }
  assert (Hnew : forall w, succ c w <> Some w).
  { intros w E. destruct (follows O _ _ E) as (H & _ & E'). apply joined_sym in E'.
    apply (three_roots _ _ M w) in E'; auto. apply (on_mesh O); auto. }
  intros [p|w|w|w] j Hk E; simpl in *.
  - destruct (link S p) as [q|] eqn:Eq; [|discriminate]. injection E as <-. apply Hold in Eq.
    repeat split; intros Ek; apply kept_is_rest in Ek; tauto.
  - destruct (link S w) as [q|] eqn:Eq; [|discriminate]. injection E as <-. apply Hold in Eq.
    unfold kept. destruct (mem q _); repeat split; intros Ek; try discriminate. injection Ek as Ek. tauto.
  - destruct (succ c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-.
    repeat split; try discriminate. intros Ek. injection Ek as ->. apply (Hnew w); auto.
  - destruct (pred c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-.
    repeat split; try discriminate. intros Ek. injection Ek as ->. apply (Hnew w), (precedes O); auto.
Qed.

Lemma rest_is_not_on : forall p, ~ divided p -> On p -> False.
Proof. intros p H H'. apply H, on_divided; auto. Qed.
Lemma parts_edge_once : forall k j, valid k -> valid j ->
  alike (label k) (label j) -> alike (label (next_part k)) (label (next_part j)) -> k = j.
Proof.
  intros k j [p Hp Hd|w Hw|w Hw|w Hw] [q Hq Hd'|u Hu|u Hu|u Hu]; simpl; try tauto; intros H1 H2.
  - f_equal. apply (root_edge_once _ _ M); auto.
  - exfalso. apply (rest_is_not_on p); auto.
    replace p with u; auto. symmetry. apply (root_edge_once _ _ M); auto. apply (on_mesh O); auto.
  - exfalso. apply (rest_is_not_on q); auto.
    replace q with w; auto. apply (root_edge_once _ _ M); auto. apply (on_mesh O); auto.
  - f_equal. apply (root_edge_once _ _ M); auto; apply (on_mesh O); auto.
  - f_equal. apply (ends_differ O); auto.
  - f_equal. apply (starts_differ O); auto.
Qed.
Lemma parts_opposites_linked : forall k j, valid k -> valid j ->
  alike (label k) (label (next_part j)) -> alike (label (next_part k)) (label j) -> part_link S c k = Some j.
Proof.
  assert (Hold : forall k j p q, valid k -> valid j -> k = Rest p \/ k = Edge p -> j = Rest q \/ j = Edge q ->
    p < size S -> q < size S -> same_root lk p (next q) -> same_root lk (next p) q -> part_link S c k = Some j).
  { intros k j p q Hk Hj Ek Ej Hp Hq H1 H2. destruct (kept_itself _ _ Hk Ek) as [<- _].
    destruct (kept_itself _ _ Hj Ej) as [<- _]. rewrite part_link_kept.
    unfold lk. rewrite (root_opposites_linked _ _ M p q); auto. }
  intros k j Hk Hj; pose proof Hk as Hk'; pose proof Hj as Hj';
    destruct Hk' as [p Hp Hd|w Hw|w Hw|w Hw], Hj' as [q Hq Hd'|u Hu|u Hu|u Hu]; simpl label; simpl alike; try tauto;
    intros H1 H2.
  - apply (Hold _ _ p q); auto.
  - apply (Hold _ _ p u); auto. apply (on_mesh O); auto.
  - apply (Hold _ _ w q); auto. apply (on_mesh O); auto.
  - apply (Hold _ _ w u); auto; apply (on_mesh O); auto.
  - simpl. rewrite (follows_if_it_can O w u); auto.
  - simpl. apply joined_sym in H2. apply (follows_if_it_can O u w) in H2; auto. apply (precedes O) in H2. rewrite H2. auto.
Qed.
Lemma parts_faces_differ : forall k j, valid k -> valid j -> alike (label k) (label j) ->
  alike (label (next_part k)) (label (prev_part j)) -> alike (label (prev_part k)) (label (next_part j)) -> False.
Proof.
  assert (Hnew : forall w u, On w -> On u -> same_root lk (next w) u -> same_root lk (next u) w -> False).
  { intros w u Hw Hu H1 H2. apply (no_two_follow_each_other O w u); apply (follows_if_it_can O); auto. }
  intros k j [p Hp Hd|w Hw|w Hw|w Hw] [q Hq Hd'|u Hu|u Hu|u Hu]; simpl; try tauto; intros H1 H2 H3.
  - apply (root_faces_differ _ _ M p q); auto.
  - apply (Hnew w u); auto. apply joined_sym; auto.
  - apply (Hnew w u); auto. apply joined_sym; auto.
  - apply (Hnew w u); auto. apply joined_sym; auto.
Qed.

Lemma manifold_now : manifold (faces_then c) lk'.
Proof.
  constructor.
  - intros x y E. apply link_inside in E. destruct E as (k & j & Hk & Hj & -> & -> & _). auto using number_below.
  - intros x y E. apply link_inside in E. destruct E as (k & j & Hk & Hj & -> & -> & E).
    destruct (part_link_involution _ _ Hk E) as [_ E']. rewrite link_number, E'; auto.
  - intros x y E Ef. apply link_inside in E. destruct E as (k & j & Hk & Hj & -> & -> & E).
    destruct (no_part_links_its_face _ _ Hk E) as (H1 & H2 & H3).
    destruct (of_one_face _ _ Ef) as [E1|[E1|E1]]; rewrite ?next_number, ?prev_number in E1;
      apply number_injective in E1; auto using next_valid, prev_valid.
  - intros x Hx H. destruct (numbered x Hx) as (k & Hk & ->). rewrite next_number in H.
    apply same_root_now in H; auto using next_valid.
    destruct Hk as [p Hp Hd|w Hw|w Hw|w Hw]; simpl in H; auto; revert H; apply (three_roots _ _ M); auto.
    apply (on_mesh O); auto.
  - intros x y Hx Hy H1 H2. destruct (numbered x Hx) as (k & Hk & ->), (numbered y Hy) as (j & Hj & ->).
    rewrite !next_number in H2. apply same_root_now in H1, H2; auto using next_valid.
    f_equal. apply parts_edge_once; auto.
  - intros x y Hx Hy H1 H2. destruct (numbered x Hx) as (k & Hk & ->), (numbered y Hy) as (j & Hj & ->).
    rewrite next_number in H1, H2. apply same_root_now in H1, H2; auto using next_valid.
    rewrite link_number, (parts_opposites_linked k j); auto.
  - intros x y Hx Hy H1 H2 H3. destruct (numbered x Hx) as (k & Hk & ->), (numbered y Hy) as (j & Hj & ->).
    rewrite next_number, prev_number in H2, H3. apply same_root_now in H1, H2, H3; auto using next_valid, prev_valid.
    apply (parts_faces_differ k j); auto.
Qed.

(* ---- the labels and marks ---- *)
Lemma origin_number : forall k, valid k -> origin S' (number c k) = part_origin S c k.
Proof. intros k Hk. unfold S', insert. cbn [origin]. rewrite part_of_number; auto. Qed.
Lemma torn_number : forall k, valid k -> torn S' (number c k) = part_torn S c k.
Proof.
  intros k Hk. unfold S', insert. cbn [torn].
  rewrite (proj2 (Nat.ltb_lt _ _) (number_below k Hk)), part_of_number; auto.
Qed.
Lemma old_or_new : forall k, valid k -> match label k with
  | Some p => p < size S /\ part_origin S c k = origin S p /\ origin S p < vertices S
  | None => vertices S <= part_origin S c k < vertices S' end.
Proof.
  intros k Hk. destruct (label k) as [p|] eqn:E.
  - destruct (label_is_keep _ _ Hk E) as [Hp _]. split; auto. split; [|apply (origin_in_range _ W); auto].
    destruct k; simpl in *; congruence.
  - destruct Hk as [p Hp Hd|w Hw|w Hw|w Hw]; try discriminate. unfold S', insert, new_vertex, part_origin. cbn [vertices].
    unfold new_vertex. destruct (second c w) eqn:Es.
    + assert (Ht : existsb (second c) (outline c) = true) by (apply existsb_exists; exists w; auto). rewrite Ht. lia.
    + destruct (existsb _ _); lia.
Qed.
Lemma kept_torn : forall q, part_torn S c (kept c q) = torn S q.
Proof. intros q. unfold kept. destruct (mem q _); auto. Qed.
Lemma kept_origins : forall q, part_origin S c (kept c q) = origin S q /\
  part_origin S c (next_part (kept c q)) = origin S (next q).
Proof. intros q. unfold kept. destruct (mem q _); auto. Qed.

(* An insertion into a well-formed mesh gives a well-formed mesh: I2 to I8. *)
Theorem cone_keeps_well_formed : well_formed S'.
Proof.
  constructor.
  - exact manifold_now.
  - intros x Hx. destruct (numbered x Hx) as (k & Hk & ->). rewrite origin_number by auto.
    pose proof (old_or_new k Hk) as H. destruct (label k); [|tauto]. destruct H as (_ & -> & H).
    unfold S', insert. cbn [vertices]. destruct (existsb _ _); lia.
  - intros x y E. apply link_inside in E. destruct E as (k & j & Hk & Hj & -> & -> & E). rewrite !torn_number by auto.
    destruct k as [p|w|w|w]; simpl in E.
    + destruct (link S p) as [q|] eqn:Eq; [|discriminate]. injection E as <-. rewrite kept_torn.
      apply (torn_both_sides _ W); auto.
    + destruct (link S w) as [q|] eqn:Eq; [|discriminate]. injection E as <-. rewrite kept_torn.
      apply (torn_both_sides _ W); auto.
    + destruct (succ c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-. apply (precedes O) in Eu.
      simpl. rewrite Eu. auto.
    + destruct (pred c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-. simpl. rewrite Eu. auto.
  - intros x E. destruct (le_lt_dec (3 * faces_then c) x) as [H|H].
    { unfold S', insert. cbn [torn]. apply Nat.ltb_ge in H. rewrite H. auto. }
    destruct (numbered x H) as (k & Hk & ->). rewrite torn_number by auto. fold lk' in E. rewrite link_number in E by auto.
    destruct k as [p|w|w|w]; simpl in *.
    + apply (boundary_not_torn _ W). destruct (link S p); simpl in E; congruence.
    + apply (boundary_not_torn _ W). destruct (link S w); simpl in E; congruence.
    + apply (cut_follows O). destruct (succ c w); simpl in E; congruence.
    + destruct (pred c w); simpl in E; congruence.
  - intros x y E. apply link_inside in E. destruct E as (k & j & Hk & Hj & -> & -> & E).
    rewrite !next_number, torn_number, !origin_number by auto using next_valid.
    destruct k as [p|w|w|w]; simpl in E.
    + destruct (link S p) as [q|] eqn:Eq; [|discriminate]. injection E as <-.
      destruct (kept_origins q) as [-> ->]. apply (pair_agrees _ W); auto.
    + destruct (link S w) as [q|] eqn:Eq; [|discriminate]. injection E as <-.
      destruct (kept_origins q) as [-> ->]. apply (pair_agrees _ W); auto.
    + destruct (succ c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-. apply (cut_if_apart O); auto.
    + destruct (pred c w) as [u|] eqn:Eu; [|discriminate]. injection E as <-. simpl. rewrite Eu.
      apply (precedes O) in Eu. rewrite (cut_if_apart O _ _ Eu). intuition congruence.
  - intros x y Hx Hy E. destruct (numbered x Hx) as (k & Hk & ->), (numbered y Hy) as (j & Hj & ->).
    apply same_root_now; auto. rewrite !origin_number in E by auto.
    pose proof (old_or_new k Hk) as H1. pose proof (old_or_new j Hj) as H2.
    destruct (label k) as [p|], (label j) as [q|]; simpl; auto; try lia.
    apply (one_root _ W); try tauto. destruct H1 as (_ & H1 & _), H2 as (_ & H2 & _). congruence.
Qed.
End Proof.
