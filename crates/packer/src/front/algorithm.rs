//! The filling algorithm: Algorithm 1 of Platzer 2022, section 4.1.4, adapted from Lozano et al.
//! 2016 (Computers & Mathematics with Applications 71, 1586-1601).

use super::assembly::Assembly;
use super::block::Block;
use super::places::Workspace;

/// Fills the space around the front spheres of a block, and around those placed meanwhile. The
/// comments quote the lines of the printed algorithm, except for its bondingList: bonds are found
/// when all spheres have come to rest. Of all candidate points the one nearest to the seed is
/// taken.
pub(super) fn fill(assembly: &Assembly, block: &mut Block, workspace: &mut Workspace) {
    // while frontSpheresQueue.size() != 0 do
    //   initialParticle <- frontSpheresQueue[1]
    while let Some(initial) = block.take() {
        let (sphere, seed) = initial;
        workspace.begin();
        // rnew <- getNewParticle(PSD)
        // neighbouringParticles <- getNeighbours(initialParticle, rnew, grid)
        // for i, j over neighbouringParticles do
        //   intersectionCurve <- getHaloIntersection(initialParticle, neighbouringParticles[i])
        //   candidatePoints <- getCandidatePoint(intersectionCurve, neighbouringParticles[j])
        //   if noParticleIntersection(candidatePoints, neighbouringParticles) then
        //     if noBoundaryIntersection(candidatePoints, grid) then
        while let Some(point) = block.candidate(assembly, workspace, &initial) {
            // newParticle <- particle(candidatePoints, rnew)
            let new = assembly.sphere(&point.centre, assembly.radius(point.quantile));
            // add newParticle to frontSpheresQueue, assemblyList, neighbouringParticles and grid
            block.place(assembly, (new, seed), point.quantile);
            workspace.add_neighbour(&sphere, &new, assembly.reduced(workspace.gathered));
        }
        // remove initialParticle from frontSpheresQueue
        block.retire(initial);
    }
}
