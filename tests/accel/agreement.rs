use lucerna::accel::{Accel, BuildOptions, RayKind, brute::Brute, bvh::Bvh};
use lucerna::geometry::{HitPacket, LANES, RayPacket};

use crate::rays::RayMaker;
use crate::rng::Rng;
use crate::worlds;

fn intersect(accel: &dyn Accel, rays: &[RayPacket]) -> Vec<HitPacket> {
    let mut hits = vec![HitPacket::EMPTY; rays.len()];
    accel.intersect(RayKind::Bounce, rays, &mut hits, None);
    hits
}

#[test]
fn bvh_and_brute_force_give_the_same_bits() {
    for (name, world) in worlds::all() {
        let maker = RayMaker::new(&world);
        let rng = &mut Rng::new(7);
        let mut packets = Vec::new();
        RayPacket::pack((0..20_000).map(|id| maker.ray(rng, id)), &mut packets);
        let reference = intersect(&Brute::new(&world), &packets);
        let bvh = intersect(&Bvh::build(&world, &BuildOptions::default()), &packets);
        let (mut hits, mut differ, mut t_differ) = (0, 0, 0);
        for i in 0..packets.len() * LANES {
            let (a, b) = (&reference[i / LANES], &bvh[i / LANES]);
            let lane = i % LANES;
            hits += usize::from(a.is_hit(lane));
            differ += usize::from(a.get(lane) != b.get(lane));
            t_differ += usize::from(a.t[lane].to_bits() != b.t[lane].to_bits());
            if a.get(lane) != b.get(lane) && differ < 4 {
                eprintln!(
                    "{:?} {:?} {} {:?} {}",
                    packets[i / LANES].get(lane),
                    a.get(lane),
                    a.t[lane],
                    b.get(lane),
                    b.t[lane]
                );
            }
        }
        eprintln!("{name}: {hits} hits, {differ} differ, {t_differ} t");
    }
}
