"""Renders the grid with both programs and judges it. Needs mitsuba and numpy."""

import os
import subprocess
from pathlib import Path

import mitsuba as mi
import numpy as np

from scenes import all_scenes

BLOCK = 4
ALLOWED = 0.003


def read(path):
    bitmap = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return np.array(bitmap, dtype=np.float64)


def make_files(work):
    """The pictures and meshes that scenes name."""
    rng = np.random.default_rng(1)
    y, x = np.mgrid[0:16, 0:24]
    picture = np.stack([0.15 + 0.7 * (x / 23), 0.15 + 0.7 * (y / 15), 0.3 + 0.4 * ((x // 4 + y // 4) % 2)], axis=-1)
    picture[:4, :6] = [0.9, 0.1, 0.1]
    save8(work / "picture.png", picture)
    y, x = np.mgrid[0:64, 0:64] / 64.0
    bumps = 0.5 + 0.25 * np.sin(2 * np.pi * 2 * x) * np.sin(2 * np.pi * 3 * y)
    save8(work / "bumps.png", np.stack([bumps] * 3, axis=-1))
    slope = np.stack([0.4 * np.cos(2 * np.pi * 2 * x), 0.4 * np.sin(2 * np.pi * 3 * y), np.ones_like(x)], axis=-1)
    slope /= np.linalg.norm(slope, axis=-1, keepdims=True)
    save8(work / "normals.png", 0.5 + 0.5 * slope)
    y, x = np.mgrid[0:32, 0:64]
    sky = 0.3 + 0.3 * np.stack([y / 31.0, 1 - y / 31.0, x / 63.0], axis=-1)
    sky[8:11, 20:24] = [12, 10, 8]
    mi.Bitmap(sky.astype(np.float32)).write(str(work / "sky.exr"))
    curves(work)
    blob(work, rng)


def curves(work):
    """A thick coil that gets thinner, and some straws."""
    t = np.linspace(0, 1, 14)
    coil = np.stack([np.cos(9 * t) * (1 - 0.4 * t), 1.6 * t - 0.75, np.sin(9 * t) * (1 - 0.4 * t), 0.22 - 0.15 * t], axis=-1)
    straws = [
        np.array([[-0.9 + 0.45 * i, -1.0, 0.8, 0.06], [-0.8 + 0.4 * i, -0.4, 0.9, 0.05], [-0.7 + 0.4 * i, 0.2, 0.5, 0.04], [-0.9 + 0.5 * i, 0.9, 0.6, 0.02]])
        for i in range(5)
    ]
    text = "\n\n".join("\n".join(" ".join(f"{x:.6f}" for x in point) for point in curve) for curve in [coil, *straws])
    for kind in ("linearcurve", "bsplinecurve"):
        (work / f"{kind}.txt").write_text(text + "\n")


def save8(path, values):
    mi.Bitmap((np.clip(values, 0, 1) * 255 + 0.5).astype(np.uint8)).write(str(path))


def blob(work, rng):
    """A bumpy ball with texture coordinates: with normals in blob.obj and blob.ply, without in flat.obj."""
    n, m = 12, 20
    bumps = rng.uniform(0.8, 1.1, (n + 1, m))
    vertices, uvs = [], []
    for i in range(n + 1):
        for j in range(m + 1):
            theta, phi = np.pi * (0.02 + 0.96 * i / n), 2 * np.pi * j / m
            r = bumps[i, j % m]
            vertices.append(r * np.array([np.sin(theta) * np.cos(phi), np.cos(theta), -np.sin(theta) * np.sin(phi)]))
            uvs.append((j / m, i / n))
    vertices = np.array(vertices)
    normals = vertices / np.linalg.norm(vertices, axis=1, keepdims=True)
    faces = []
    for i in range(n):
        for j in range(m):
            a, b = i * (m + 1) + j, i * (m + 1) + j + 1
            faces += [(a, a + m + 1, b), (b, a + m + 1, b + m + 1)]
    for name, with_normals in (("blob.obj", True), ("flat.obj", False)):
        with open(work / name, "w") as f:
            f.writelines(f"v {v[0]:.6f} {v[1]:.6f} {v[2]:.6f}\n" for v in vertices)
            f.writelines(f"vt {u:.6f} {v:.6f}\n" for u, v in uvs)
            if with_normals:
                f.writelines(f"vn {v[0]:.6f} {v[1]:.6f} {v[2]:.6f}\n" for v in normals)
            corner = (lambda k: f"{k}/{k}/{k}") if with_normals else (lambda k: f"{k}/{k}")
            f.writelines("f " + " ".join(corner(k + 1) for k in face) + "\n" for face in faces)
    with open(work / "colored.ply", "w") as f:
        names = ["x", "y", "z", "r", "g", "b", "other_x", "other_y", "other_z", "gloss_0"]
        f.write(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n")
        f.writelines(f"property float {name}\n" for name in names)
        f.write(f"element face {len(faces)}\nproperty list uchar int vertex_indices\n")
        f.writelines(f"property float {name}\n" for name in ("r", "g", "b", "number_0"))
        f.write("end_header\n")
        for v in vertices:
            color, other = 0.5 + 0.4 * np.sin(3 * v), np.abs(v) * 0.6
            f.write(" ".join(f"{c:.6f}" for c in (*v, *color, *other, 0.1 + 0.2 * abs(v[0]))) + "\n")
        for i, face in enumerate(faces):
            color = [0.2 + 0.6 * (i % 3 == 0), 0.2 + 0.5 * (i % 5 == 0), 0.3 + 0.4 * (i % 2)]
            f.write(f"3 {face[0]} {face[1]} {face[2]} " + " ".join(f"{c:.6f}" for c in (*color, 0.3 + 0.6 * (i % 2))) + "\n")
    with open(work / "blob.ply", "w") as f:
        f.write(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n")
        f.writelines(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
        f.write(f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        for v, normal, uv in zip(vertices, normals, uvs):
            f.write(" ".join(f"{c:.6f}" for c in (*v, *normal, *uv)) + "\n")
        f.writelines("3 " + " ".join(map(str, face)) + "\n" for face in faces)


def ours(program, path, mode, args, work):
    pictures = []
    for seed in range(args.seeds):
        out = work / "ours.exr"
        command = [program, "render", str(path), "-o", str(out), "--color", mode, "--quiet", "--seed", str(seed + 1)]
        command += ["-D", f"spp={args.spp}", "-D", f"res={args.resolution}"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(done.stderr.strip().splitlines()[0])
        pictures.append(read(out))
    return np.array(pictures)


def theirs(path, mode, args):
    mi.set_variant(f"llvm_ad_{mode}")
    scene = mi.load_file(str(path), spp=args.spp, res=args.resolution)
    renders = (mi.render(scene, spp=args.spp, seed=seed) for seed in range(args.seeds))
    return np.array([np.array(picture)[..., :3] for picture in renders], dtype=np.float64)


def blocks(pictures):
    count, height, width, channels = pictures.shape
    rows, columns = height // BLOCK, width // BLOCK
    cut = pictures[:, : rows * BLOCK, : columns * BLOCK]
    return cut.reshape(count, rows, BLOCK, columns, BLOCK, channels).mean((2, 4))


def z_values(a, b):
    """Of the difference of the means of two sets of values."""
    mean_a, mean_b = a.mean(0), b.mean(0)
    variance = a.var(0, ddof=1) / len(a) + b.var(0, ddof=1) / len(b)
    floor = 1e-4 * max(mean_b.mean(), 1e-12)
    return (mean_a - mean_b) / np.sqrt(variance + (ALLOWED * mean_b) ** 2 + floor**2)


def judge(a, b):
    a_blocks, b_blocks = blocks(a), blocks(b)
    z = z_values(a_blocks, b_blocks)
    a_mean, b_mean = a.mean((1, 2)), b.mean((1, 2))
    z_mean = z_values(a_mean, b_mean)
    difference = a_mean.mean(0) / np.maximum(b_mean.mean(0), 1e-12) - 1
    # With few renders each the variances themselves are uncertain: z has the tails of Student's t.
    limit = 4 if len(a) >= 16 else 6
    beyond = float((np.abs(z) > limit).mean())
    means_fine = ((np.abs(z_mean) < limit) | (np.abs(difference) < 0.005)).all()
    return {
        "fine": bool(means_fine) and beyond <= 0.01,
        "difference": 100 * difference[np.abs(difference).argmax()],
        "z_mean": z_mean.ravel()[np.abs(z_mean).argmax()],
        "beyond": 100 * beyond,
        "rms": float(np.sqrt((z**2).mean())),
        "worst": z.ravel()[np.abs(z).argmax()],
    }


def run(args, root):
    program = os.environ.get("LUCERNA", str(root / "target/release/lucerna"))
    work = Path(args.work)
    work.mkdir(parents=True, exist_ok=True)
    mi.set_variant("scalar_rgb")
    make_files(work)
    lines = [f"| scene | mode | agrees | mean differs by % | its z | rms z | blocks beyond, % | worst z |", "|---|---|---|---|---|---|---|---|"]
    print("\n".join(lines), flush=True)
    failures = 0
    for name, text in all_scenes():
        if args.only not in name:
            continue
        path = work / (name.replace("/", "-") + ".xml")
        path.write_text(text)
        for mode in args.mode or ["rgb", "spectral"]:
            line = one(program, name, path, mode, args, work)
            failures += " | no | " in line
            lines.append(line)
            print(line, flush=True)
    count = len(lines) - 2
    summary = f"\n{count - failures} of {count} agree."
    print(summary)
    if args.table:
        Path(args.table).write_text("\n".join(lines) + "\n" + summary + "\n")
    return 1 if failures else 0


def one(program, name, path, mode, args, work):
    try:
        b = theirs(path, mode, args)
    except Exception as error:  # what Mitsuba refuses is no failure of ours
        return f"| {name} | {mode} | - | Mitsuba: {str(error).strip().splitlines()[-1][:90]} | | | | |"
    try:
        a = ours(program, path, mode, args, work)
    except RuntimeError as error:
        return f"| {name} | {mode} | no | {error} | | | | |"
    if a.shape != b.shape:
        return f"| {name} | {mode} | no | sizes {a.shape[1:3]} and {b.shape[1:3]} | | | | |"
    j = judge(a, b)
    np.save(work / f"{path.stem}-{mode}.npy", np.stack([a.mean(0), b.mean(0)]))
    fine = "yes" if j["fine"] else "no"
    return (
        f"| {name} | {mode} | {fine} | {j['difference']:+.2f} | {j['z_mean']:+.1f} | {j['rms']:.2f} | {j['beyond']:.1f} | {j['worst']:+.1f} |"
    )
