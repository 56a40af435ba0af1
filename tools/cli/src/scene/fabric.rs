//! The keys of `[fabric]`: density, and the resistance to stretch and bending.

use tearmesh::Vector;
use tearmesh_cloth::Method;
use tearmesh_cloth::scene::{Frame, Scene};
use tearmesh_cloth::{Bending, Buckling, Weave};

use super::kinds::set;
use super::read::{Place, SceneFile, Table};
use super::schema::Fabric;
use crate::choice::BendLaw;
use crate::say::Fault;

impl SceneFile {
    /// Changes the fabric of a scene whose method is chosen.
    pub(super) fn fabric(&self, scene: &mut Scene, frame: &Frame, faults: &mut Vec<Fault>) {
        let Some(table) = &self.fabric else {
            return;
        };
        let fabric = &mut scene.fabric;
        set(&mut scene.areal_density_kg_per_m2, table.density_kg_per_m2);
        set(&mut fabric.stretch_n_per_m, table.stretch_n_per_m);
        set(&mut fabric.copies, table.copies.map(|word| word.0));
        set(&mut fabric.unbend, table.unbend.map(|word| word.0));
        for done in [self.bend(table, scene), self.weave(table, scene, frame)] {
            faults.extend(done.err().map(|fault| *fault));
        }
    }

    /// What resists bending: springs, or arcs that buckle.
    fn bend(&self, table: &Table<Fabric>, scene: &mut Scene) -> Result<(), Box<Fault>> {
        let place = &table.place;
        let buckles = table.bend_law.is_some_and(|law| law.0 == BendLaw::Buckling);
        let (foreign, other): (&[&str], _) = match buckles {
            true => (&["bend_n_per_m"], "spring"),
            false => (&["flexural_n_m2", "buckles_below"], "buckling"),
        };
        if let Some(&key) = place.those_of(foreign).first() {
            let message = format!("`{key}` goes with bend_law = \"{other}\"");
            return Err(self.fault(place, key, "E-SCENE-CLASH", message));
        }
        if !buckles {
            if let Some(stiffness_n_per_m) = table.bend_n_per_m.map(f64::from) {
                let spring = Bending::Spring { stiffness_n_per_m };
                scene.fabric.bend = (stiffness_n_per_m > 0.0).then_some(spring);
            }
            return Ok(());
        }
        let flexural_n_m2 = table.flexural_n_m2.map(f64::from);
        let flexural_n_m2 = flexural_n_m2.ok_or_else(|| self.missing(place, "flexural_n_m2"))?;
        let law = Buckling::new(table.buckles_below.map_or(0.95, f64::from));
        let law = law.ok_or_else(|| {
            let message = "`buckles_below` is above 0.592 and under 1".to_owned();
            self.fault(place, "buckles_below", "E-SCENE-RANGE", message)
        })?;
        scene.fabric.bend = Some(Bending::Buckling { flexural_n_m2, law });
        self.has_forces(scene, place, "bend_law", "know no arcs")
    }

    /// A fabric of triangles, which stands for springs on edges unless these are named as well.
    fn weave(
        &self,
        table: &Table<Fabric>,
        scene: &mut Scene,
        frame: &Frame,
    ) -> Result<(), Box<Fault>> {
        let place = &table.place;
        let keys = ["warp_n_per_m", "weft_n_per_m", "shear_n_per_m", "warp"];
        let Some(&key) = place.those_of(&keys).first() else {
            return Ok(());
        };
        let warp_n_per_m = table
            .warp_n_per_m
            .ok_or_else(|| self.missing(place, keys[0]))?;
        let weft_n_per_m = table
            .weft_n_per_m
            .ok_or_else(|| self.missing(place, keys[1]))?;
        scene.fabric.weave = Some(Weave {
            warp_n_per_m: warp_n_per_m.into(),
            weft_n_per_m: weft_n_per_m.into(),
            shear_n_per_m: table.shear_n_per_m.map_or(0.0, f64::from),
            warp: table
                .warp
                .map_or_else(|| frame.along.vector(), Vector::from),
        });
        scene.fabric.stretch_n_per_m = table.stretch_n_per_m.map_or(0.0, f64::from);
        self.has_forces(scene, place, key, "have no triangles")
    }

    /// Refuses methods that move springs, where a key asks for something else.
    fn has_forces(
        &self,
        scene: &Scene,
        place: &Place,
        key: &str,
        lack: &str,
    ) -> Result<(), Box<Fault>> {
        if matches!(scene.solver, Method::Pbd(_) | Method::Xpbd(_)) {
            let message = format!("pbd and xpbd move springs, and {lack}");
            let fault = self.fault(place, key, "E-SCENE-CLASH", message);
            let help = "add method = \"implicit\" to [solver]; verlet and provot do as well";
            return Err(Box::new(fault.help(help.to_owned())));
        }
        Ok(())
    }
}
