//! The law of path lengths: with which probability a path takes so many rays. Means do not see a walk that ends too late
//! and is weighted for it; this does.

use super::walk::Walk;

impl Walk<'_> {
    /// Probabilities of 0, 1, ... `most` rays for a path whose first ray meets each patch with probability `seen`: the
    /// geometric law of roulette, patch by patch. `None` where a path may split, where light is sampled and the enclosure
    /// is no sphere (a light seen edge-on costs no shadow ray), and where rays escape.
    pub fn lengths(&self, seen: &[f64], most: usize) -> Option<Vec<f64>> {
        let enclosure = self.enclosure();
        let patches = enclosure.patches();
        let lit = self.samples_lights() && !enclosure.is_spherical();
        if self.branches() > 1 || lit || !enclosure.is_closed() {
            return None;
        }
        let mut lengths = vec![0.0; most + 1];
        let mut alive = seen.to_vec();
        let (mut rays, mut bounce) = (1, 0);
        while rays <= most {
            rays += usize::from(self.samples_light(bounce));
            let mut next = vec![0.0; patches.len()];
            for (i, patch) in patches.iter().enumerate() {
                let goes_on = self.children(bounce, patch);
                if goes_on > 1.0 {
                    return None;
                }
                if let Some(length) = lengths.get_mut(rays) {
                    *length += alive[i] * (1.0 - goes_on);
                }
                let met = enclosure.seen_from(i);
                next.iter_mut().zip(met).for_each(|(next, p)| *next += alive[i] * goes_on * p);
            }
            alive = next;
            rays += 1;
            bounce += 1;
        }
        Some(lengths)
    }
}
