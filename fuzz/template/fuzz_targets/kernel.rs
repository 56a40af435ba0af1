//! Any bytes are a script: your kernel and tearmesh make the same triangles of it.
//!
//! Put in the names of your kernel, here of one that can only split vertices, and add its other operations.
#![no_main]

use kernel::Kernel;
use libfuzzer_sys::fuzz_target;
use tearmesh::script::{Fault, Operation, Script, Step};

fuzz_target!(|bytes: &[u8]| {
    let mut script = Script::from_bytes(bytes);
    script.operations.retain_mut(|operation| match operation {
        Operation::Split { fault, .. } => {
            // Leave this out if your kernel refuses faces that are not around the vertex, or named twice.
            *fault = Fault::None;
            true
        }
        _ => false,
    });
    let mut kernel = None;
    script.run(|world, step| {
        let triangles = world.mesh.indices().as_chunks::<3>().0;
        let kernel =
            kernel.get_or_insert_with(|| Kernel::new(world.mesh.vertex_count(), triangles));
        if let Step::Split {
            vertex,
            faces,
            outcome,
        } = step
        {
            let faces: Vec<usize> = faces.iter().map(|face| face.index()).collect();
            let is_done = kernel.split(vertex.index(), &faces);
            assert_eq!(is_done, outcome.is_ok(), "after {step:?} of\n{script}");
        }
        assert_eq!(kernel.triangles(), triangles, "after {step:?} of\n{script}");
    });
});
