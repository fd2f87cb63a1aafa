"""The grid: scenes with one feature each, as Mitsuba's XML. Every scene is looked at by the same camera and lit alike unless the
feature is one of those."""

CAMERA = """<sensor type="perspective"><float name="fov" value="38"/>
<transform name="to_world"><lookat origin="0, 1.1, 4" target="0, 0.1, 0" up="0, 1, 0"/></transform>{film}{sampler}</sensor>"""
SAMPLER = '<sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>'


def film(filter='<rfilter type="box"/>', more=""):
    return (
        '<film type="hdrfilm"><integer name="width" value="$res"/><integer name="height" value="$res"/>'
        f'<string name="pixel_format" value="rgb"/>{more}{filter}</film>'
    )


FLOOR = """<shape type="rectangle"><transform name="to_world"><scale value="4"/><rotate x="1" angle="-90"/><translate y="-1"/></transform>
<bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.3"/></bsdf></shape>"""
LAMP = """<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><scale value="1.3"/><translate x="-1.5" y="3.5" z="2"/>
</transform><emitter type="area"><rgb name="radiance" value="9, 8, 6"/></emitter></shape>"""
SKY = '<emitter type="constant"><rgb name="radiance" value="0.25, 0.3, 0.4"/></emitter>'


def scene(content, camera=None, integrator='<integrator type="path"><integer name="max_depth" value="5"/></integrator>', light=LAMP + SKY,
          floor=FLOOR):
    camera = camera or CAMERA.format(film=film(), sampler=SAMPLER)
    return (
        '<scene version="3.0.0"><default name="spp" value="16"/><default name="res" value="32"/>'
        f"{integrator}{camera}{floor}{light}{content}</scene>"
    )


def ball(bsdf):
    return scene(f'<shape type="sphere">{bsdf}</shape>')


def quad(bsdf, turn=-35):
    """A square that fills most of the picture."""
    return scene(f'<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="{turn}"/></transform>{bsdf}</shape>')


def rgb(name, value):
    return f'<rgb name="{name}" value="{value}"/>'


def number(name, value):
    return f'<float name="{name}" value="{value}"/>'


def bsdf(kind, content="", name=""):
    named = f' name="{name}"' if name else ""
    return f'<bsdf type="{kind}"{named}>{content}</bsdf>'


def two(content):
    return bsdf("twosided", content)


CHECKS = '<texture type="checkerboard" name="{name}">{content}<transform name="to_uv"><scale x="3" y="2"/></transform></texture>'


def bitmap(name, content=""):
    return f'<texture type="bitmap" name="{name}"><string name="filename" value="picture.png"/>{content}</texture>'


def bsdfs():
    gold = rgb("eta", "0.2, 0.92, 1.1") + rgb("k", "3.9, 2.45, 2.1")
    yield "diffuse", ball(bsdf("diffuse", rgb("reflectance", "0.2, 0.6, 0.7")))
    yield "diffuse-spectrum", ball(bsdf("diffuse", '<spectrum name="reflectance" value="400:0.1, 500:0.2, 600:0.8, 700:0.6"/>'))
    yield "diffuse-behind", quad(bsdf("diffuse"), 145)
    yield "twosided", quad(two(bsdf("diffuse", rgb("reflectance", "0.7, 0.2, 0.2"))), 145)
    yield "twosided-two", quad(two(bsdf("diffuse", rgb("reflectance", "0.7, 0.2, 0.2")) + bsdf("diffuse", rgb("reflectance", "0.1, 0.6, 0.2"))), 145)
    yield "conductor-mirror", ball(bsdf("conductor"))
    yield "conductor-eta-k", ball(bsdf("conductor", gold))
    yield "conductor-reflectance", ball(bsdf("conductor", gold + rgb("specular_reflectance", "0.5, 0.6, 0.7")))
    for metal in ("Au", "Cu", "Al", "Ag"):
        yield f"conductor-{metal}", ball(bsdf("conductor", f'<string name="material" value="{metal}"/>'))
    for kind in ("beckmann", "ggx"):
        dist = f'<string name="distribution" value="{kind}"/>'
        for alpha in (0.1, 0.3, 0.6):
            yield f"roughconductor-{kind}-{alpha}", ball(bsdf("roughconductor", gold + dist + number("alpha", alpha)))
        yield f"roughconductor-{kind}-uv", quad(bsdf("roughconductor", gold + dist + number("alpha_u", 0.08) + number("alpha_v", 0.4)))
        for alpha in (0.1, 0.4):
            yield f"roughdielectric-{kind}-{alpha}", ball(bsdf("roughdielectric", dist + number("alpha", alpha)))
            yield f"roughplastic-{kind}-{alpha}", ball(bsdf("roughplastic", dist + number("alpha", alpha) + rgb("diffuse_reflectance", "0.6, 0.3, 0.1")))
    yield "roughconductor-plain-normals", ball(bsdf("roughconductor", gold + number("alpha", 0.2) + '<boolean name="sample_visible" value="false"/>'))
    yield "roughconductor-texture", quad(bsdf("roughconductor", gold + CHECKS.format(name="alpha", content=number("color0", 0.1) + number("color1", 0.4))))
    yield "dielectric", ball(bsdf("dielectric"))
    yield "dielectric-water", ball(bsdf("dielectric", '<string name="int_ior" value="water"/>'))
    yield "dielectric-bubble", ball(bsdf("dielectric", number("int_ior", 1) + number("ext_ior", 1.5)))
    yield "dielectric-tinted", ball(bsdf("dielectric", rgb("specular_reflectance", "0.5, 0.9, 0.9") + rgb("specular_transmittance", "0.9, 0.7, 0.5")))
    yield "thindielectric", ball(bsdf("thindielectric"))
    yield "thindielectric-tinted", ball(bsdf("thindielectric", number("int_ior", 2.2) + rgb("specular_transmittance", "0.9, 0.7, 0.5")))
    yield "plastic", ball(bsdf("plastic", rgb("diffuse_reflectance", "0.6, 0.3, 0.1")))
    yield "plastic-nonlinear", ball(bsdf("plastic", rgb("diffuse_reflectance", "0.6, 0.3, 0.1") + '<boolean name="nonlinear" value="true"/>'))
    yield "plastic-ior-specular", ball(bsdf("plastic", number("int_ior", 1.9) + rgb("specular_reflectance", "0.5, 0.7, 0.9")))
    yield "plastic-behind", quad(bsdf("plastic"), 145)
    yield "roughplastic-nonlinear", ball(bsdf("roughplastic", rgb("diffuse_reflectance", "0.6, 0.3, 0.1") + '<boolean name="nonlinear" value="true"/>'))
    base = rgb("base_color", "0.7, 0.4, 0.2")
    yield "principled", ball(bsdf("principled", base))
    yield "principled-metal", ball(bsdf("principled", base + number("metallic", 1) + number("roughness", 0.3)))
    yield "principled-glass", ball(bsdf("principled", base + number("spec_trans", 1) + number("roughness", 0.2)))
    yield "principled-cloth", ball(bsdf("principled", base + number("sheen", 1) + number("sheen_tint", 0.5)))
    yield "principled-lacquer", ball(bsdf("principled", base + number("clearcoat", 1) + number("clearcoat_gloss", 0.8)))
    yield "principled-flat", ball(bsdf("principled", base + number("flatness", 0.8)))
    yield "mask", quad(bsdf("mask", number("opacity", 0.3) + two(bsdf("diffuse"))))
    yield "mask-texture", quad(bsdf("mask", CHECKS.format(name="opacity", content=number("color0", 0.9) + number("color1", 0)) + two(bsdf("diffuse"))))
    twice = bsdf("mask", number("opacity", 0.6) + two(bsdf("diffuse")))
    yield "mask-of-mask", quad(bsdf("mask", number("opacity", 0.5) + twice))
    yield "blendbsdf-null", quad(bsdf("blendbsdf", number("weight", 0.3) + two(bsdf("diffuse")) + bsdf("null")))
    yield "blendbsdf", ball(bsdf("blendbsdf", number("weight", 0.3) + bsdf("diffuse") + bsdf("roughconductor", gold)))
    yield "blendbsdf-texture", quad(bsdf("blendbsdf", CHECKS.format(name="weight", content=number("color0", 0) + number("color1", 1)) + bsdf("diffuse") + bsdf("conductor")))
    yield "blendbsdf-glass", ball(bsdf("blendbsdf", number("weight", 0.5) + bsdf("dielectric") + bsdf("diffuse")))
    bump = '<texture type="bitmap"><boolean name="raw" value="true"/><string name="filename" value="bumps.png"/></texture>'
    for scale in (0.02, 0.1):
        yield f"bumpmap-{scale}", quad(bsdf("bumpmap", bump + number("scale", scale) + bsdf("diffuse")))
    yield "bumpmap-gloss", quad(bsdf("bumpmap", bump + number("scale", 0.02) + bsdf("roughconductor", gold + number("alpha", 0.2))))
    normals = '<texture type="bitmap" name="normalmap"><boolean name="raw" value="true"/><string name="filename" value="normals.png"/></texture>'
    yield "normalmap", quad(bsdf("normalmap", normals + bsdf("diffuse")))
    yield "null", quad(bsdf("null"))


def light(emitter, content='<shape type="sphere"><bsdf type="diffuse"/></shape>'):
    return scene(emitter + content, light="")


def emitters():
    place = '<transform name="to_world"><lookat origin="-1.5, 3, 2" target="0, 0, 0" up="0, 1, 0"/></transform>'
    yield "area-rgb", scene('<shape type="sphere"/>', light=LAMP)
    yield "area-behind", scene('<shape type="sphere"/>', light=LAMP.replace('angle="90"', 'angle="-90"') + SKY)
    yield "area-seen", scene('<shape type="sphere"><emitter type="area"><rgb name="radiance" value="1, 2, 1"/></emitter></shape>', light="")
    yield "area-sphere-flipped", scene('<shape type="sphere"><boolean name="flip_normals" value="true"/><emitter type="area"><rgb name="radiance" value="1, 2, 1"/></emitter></shape>')
    yield "area-bitmap", scene(f'<shape type="rectangle"><emitter type="area">{bitmap("radiance")}</emitter></shape>', light=SKY)
    for name, spectrum in {
        "number": number("radiance", 0.8),
        "constant": '<spectrum name="radiance" value="0.8"/>',
        "samples": '<spectrum name="radiance" value="400:0.2, 550:1.5, 700:1"/>',
        "irregular": '<spectrum name="radiance" type="irregular"><string name="wavelengths" value="400, 450, 700"/><string name="values" value="0.2, 1, 0.6"/></spectrum>',
        "regular": '<spectrum name="radiance" type="regular"><float name="wavelength_min" value="400"/><float name="wavelength_max" value="700"/><string name="values" value="0.2, 1, 0.6"/></spectrum>',
        "d65": '<spectrum name="radiance" type="d65"><float name="scale" value="0.7"/></spectrum>',
        "blackbody": '<spectrum name="radiance" type="blackbody"><float name="temperature" value="2000"/></spectrum>',
    }.items():
        yield f"spectrum-{name}", light(f'<emitter type="constant">{spectrum}</emitter>')
    yield "point", light(f'<emitter type="point"><point name="position" x="-1.5" y="3" z="2"/>{rgb("intensity", "20, 16, 10")}</emitter>')
    yield "spot", light(f'<emitter type="spot">{place}{rgb("intensity", "20, 16, 10")}<float name="cutoff_angle" value="22"/></emitter>')
    yield "spot-wide", light(f'<emitter type="spot">{place}{rgb("intensity", "20, 16, 10")}<float name="cutoff_angle" value="40"/><float name="beam_width" value="2"/></emitter>')
    yield "directional", light(f'<emitter type="directional"><vector name="direction" x="0.5" y="-1" z="-0.7"/>{rgb("irradiance", "2, 1.8, 1.5")}</emitter>')
    # Only paths from lights find these.
    along = lambda shape: scene(shape + '<shape type="sphere"><bsdf type="diffuse"/></shape>', light="",
                                integrator='<integrator type="ptracer"><integer name="max_depth" value="5"/></integrator>')
    above = '<transform name="to_world"><scale value="0.8"/><lookat origin="-1.5, 3, 2" target="0, 0, 0" up="0, 1, 0"/></transform>'
    normal = f'<emitter type="directionalarea">{rgb("radiance", "3, 2.5, 2")}</emitter>'
    for kind in ("rectangle", "disk"):
        yield f"directionalarea-{kind}", along(f'<shape type="{kind}">{above}{normal}</shape>')
    ball_ = '<shape type="sphere"><point name="center" x="-1.5" y="1.5" z="0.6"/><float name="radius" value="0.3"/>'
    yield "directionalarea-sphere", along(ball_ + normal.replace("3, 2.5, 2", "30, 25, 20") + "</shape>")
    yield "directionalarea-flipped", along(f'<shape type="sphere"><float name="radius" value="6"/><boolean name="flip_normals" value="true"/>{normal}</shape>')
    yield "directionalarea-path", scene(f'<shape type="rectangle">{above}{normal}</shape><shape type="sphere"/>')
    yield "constant", light(SKY)
    yield "envmap", light('<emitter type="envmap"><string name="filename" value="sky.exr"/></emitter>')
    yield "envmap-turned", light('<emitter type="envmap"><string name="filename" value="sky.exr"/><float name="scale" value="0.5"/><transform name="to_world"><rotate y="1" angle="70"/><rotate x="1" angle="20"/></transform></emitter>')
    yield "projector", light(f'<emitter type="projector">{place}{bitmap("irradiance")}<float name="scale" value="20"/><float name="fov" value="40"/></emitter>')


def textured(texture, shape="rectangle", turn=-35):
    return scene(
        f'<shape type="{shape}"><transform name="to_world"><rotate x="1" angle="{turn}"/></transform>'
        f'<bsdf type="twosided"><bsdf type="diffuse">{texture}</bsdf></bsdf></shape>'
    )


def textures():
    turned = '<transform name="to_uv"><scale x="2" y="3"/><rotate z="1" angle="30"/><translate x="0.2" y="0.4"/></transform>'
    yield "bitmap", textured(bitmap("reflectance"))
    yield "bitmap-nearest", textured(bitmap("reflectance", '<string name="filter_type" value="nearest"/>'))
    yield "bitmap-raw", textured(bitmap("reflectance", '<boolean name="raw" value="true"/>'))
    for wrap in ("repeat", "mirror", "clamp"):
        yield f"bitmap-{wrap}", textured(bitmap("reflectance", f'<string name="wrap_mode" value="{wrap}"/>{turned}'))
    for shape in ("sphere", "cube", "disk", "cylinder"):
        yield f"bitmap-on-{shape}", textured(bitmap("reflectance"), shape, 50)
    yield "checkerboard", textured(CHECKS.format(name="reflectance", content=rgb("color0", "0.8, 0.2, 0.1") + rgb("color1", "0.1, 0.2, 0.7")))
    yield "checkerboard-default", textured('<texture type="checkerboard" name="reflectance"/>')


def attributes():
    def mesh(file, texture, more=""):
        return scene(f'<shape type="ply"><string name="filename" value="{file}"/>{two(bsdf("diffuse", texture))}{more}</shape>')

    def of(name, slot="reflectance", more=""):
        return f'<texture type="mesh_attribute" name="{slot}"><string name="name" value="{name}"/>{more}</texture>'

    yield "vertex-color", mesh("colored.ply", of("vertex_color"))
    yield "vertex-color-scaled", mesh("colored.ply", of("vertex_color", more=number("scale", 0.6)))
    yield "face-color", mesh("colored.ply", of("face_color"))
    yield "vertex-other", mesh("colored.ply", of("vertex_other"))
    rough = bsdf("roughconductor", of("vertex_gloss", "alpha"))
    yield "vertex-number", scene(f'<shape type="ply"><string name="filename" value="colored.ply"/>{rough}</shape>')
    opacity = bsdf("mask", of("face_number", "opacity") + two(bsdf("diffuse")))
    # To Mitsuba a mask that is passed is an edge of the path.
    deep = '<integrator type="path"><integer name="max_depth" value="50"/></integrator>'
    yield "face-number-mask", scene(f'<shape type="ply"><string name="filename" value="colored.ply"/>{opacity}</shape>', integrator=deep)
    inner = f'<shape type="ply"><string name="filename" value="colored.ply"/>{two(bsdf("diffuse", of("face_color")))}</shape>'
    place = '<transform name="to_world"><scale value="0.7"/><rotate y="1" angle="70"/></transform>'
    yield "instance", scene(f'<shape type="shapegroup" id="g">{inner}</shape><shape type="instance"><ref id="g"/>{place}</shape>')


def shapes():
    grey = two(bsdf("diffuse", rgb("reflectance", "0.6, 0.6, 0.5")))
    one = bsdf("diffuse", rgb("reflectance", "0.6, 0.6, 0.5"))
    turn = '<transform name="to_world"><scale x="0.8" y="1.1" z="0.7"/><rotate x="1" angle="-50"/><rotate y="1" angle="25"/></transform>'
    mirror = '<transform name="to_world"><scale x="-0.8" y="1" z="0.9"/><rotate x="1" angle="-50"/></transform>'
    for kind in ("rectangle", "cube", "disk", "cylinder"):
        for label, place in (("", turn), ("-mirrored", mirror)):
            yield f"{kind}{label}", scene(f'<shape type="{kind}">{place}{one}</shape>')
        yield f"{kind}-flipped", scene(f'<shape type="{kind}">{turn}{one}<boolean name="flip_normals" value="true"/></shape>')
    yield "sphere", scene(f'<shape type="sphere"><point name="center" x="0.3" y="0.1" z="0"/><float name="radius" value="0.7"/>{one}</shape>')
    yield "cylinder-ends", scene(f'<shape type="cylinder"><point name="p0" x="-1" y="-0.5" z="0"/><point name="p1" x="0.8" y="0.6" z="0.5"/><float name="radius" value="0.4"/>{grey}</shape>')
    for kind in ("linearcurve", "bsplinecurve"):
        name = f'<string name="filename" value="{kind}.txt"/>'
        bent = '<transform name="to_world"><scale x="1.1"/><rotate y="1" angle="20"/></transform>'
        yield f"{kind}", scene(f'<shape type="{kind}">{name}{one}</shape>')
        yield f"{kind}-placed", scene(f'<shape type="{kind}">{name}{bent}{one}</shape>')
        yield f"{kind}-textured", scene(f'<shape type="{kind}">{name}{two(bsdf("diffuse", bitmap("reflectance")))}</shape>')
        yield f"{kind}-gloss", scene(f'<shape type="{kind}">{name}{bsdf("roughconductor", number("alpha", 0.2))}</shape>')
        group = f'<shape type="shapegroup" id="g"><shape type="{kind}">{name}{one}</shape></shape>'
        yield f"{kind}-instance", scene(group + f'<shape type="instance"><ref id="g"/><transform name="to_world"><scale value="0.8"/><rotate z="1" angle="40"/></transform></shape>')
    for file in ("blob.obj", "blob.ply", "flat.obj"):
        kind = file[-3:]
        name = f'<string name="filename" value="{file}"/>'
        yield f"{file}", scene(f'<shape type="{kind}">{name}{one}</shape>')
        yield f"{file}-face-normals", scene(f'<shape type="{kind}">{name}{one}<boolean name="face_normals" value="true"/></shape>')
        yield f"{file}-mirrored", scene(f'<shape type="{kind}">{name}{mirror}{one}</shape>')
        yield f"{file}-flipped", scene(f'<shape type="{kind}">{name}{one}<boolean name="flip_normals" value="true"/></shape>')
        yield f"{file}-textured", scene(f'<shape type="{kind}">{name}{two(bsdf("diffuse", bitmap("reflectance")))}</shape>')
    yield "blob-glass", scene(f'<shape type="obj"><string name="filename" value="blob.obj"/>{bsdf("dielectric")}</shape>')
    group = f'<shape type="shapegroup" id="g"><shape type="cube">{one}<transform name="to_world"><scale value="0.4"/></transform></shape></shape>'
    places = "".join(
        f'<shape type="instance"><ref id="g"/><transform name="to_world"><rotate y="1" angle="{40 * i}"/><translate x="{i - 1}"/></transform></shape>'
        for i in range(3)
    )
    yield "instance", scene(group + places)


def sensors():
    ball_ = '<shape type="sphere"/>'
    place = '<transform name="to_world"><lookat origin="0, 1.1, 4" target="0, 0.1, 0" up="0, 1, 0"/></transform>'

    def camera(kind, content, film_=None):
        return scene(ball_, camera=f'<sensor type="{kind}">{content}{film_ or film()}{SAMPLER}</sensor>')

    wide = film().replace('name="width" value="$res"', 'name="width" value="48"')
    for axis in ("x", "y", "diagonal", "smaller", "larger"):
        yield f"fov-{axis}", camera("perspective", f'{place}{number("fov", 40)}<string name="fov_axis" value="{axis}"/>', wide)
    yield "focal-length", camera("perspective", f'{place}<string name="focal_length" value="60mm"/>', wide)
    yield "principal-point", camera("perspective", f'{place}{number("fov", 40)}{number("principal_point_offset_x", 0.2)}{number("principal_point_offset_y", -0.1)}', wide)
    yield "near-clip", camera("perspective", f'{place}{number("fov", 40)}{number("near_clip", 3.3)}')
    yield "thinlens", camera("thinlens", f'{place}{number("fov", 40)}{number("aperture_radius", 0.3)}{number("focus_distance", 3.5)}')
    yield "orthographic", camera("orthographic", '<transform name="to_world"><scale x="1.8" y="1.8"/><lookat origin="0, 1.1, 4" target="0, 0.1, 0" up="0, 1, 0"/></transform>', wide)
    crop = '<integer name="crop_offset_x" value="4"/><integer name="crop_offset_y" value="10"/><integer name="crop_width" value="20"/><integer name="crop_height" value="16"/>'
    yield "crop", camera("perspective", place + number("fov", 40), film(more=crop))
    for name in ("tent", "gaussian", "mitchell", "catmullrom", "lanczos"):
        yield f"rfilter-{name}", camera("perspective", place + number("fov", 40), film(f'<rfilter type="{name}"/>'))


def integrators():
    shapes_ = '<shape type="sphere"><bsdf type="plastic"/></shape>'
    for depth in (1, 2, 3, -1):
        yield f"path-depth-{depth}", scene(shapes_, integrator=f'<integrator type="path"><integer name="max_depth" value="{depth}"/></integrator>')
    yield "direct", scene(shapes_, integrator='<integrator type="direct"/>')
    yield "ptracer", scene('<shape type="sphere"/>', integrator='<integrator type="ptracer"><integer name="max_depth" value="4"/></integrator>', light=LAMP,
                           camera=CAMERA.format(film=film(), sampler=SAMPLER))


def media():
    def volume(content, name="interior", kind="hg", g=0.5):
        phase = f'<phase type="{kind}">{number("g", g) if kind == "hg" else ""}</phase>'
        return f'<medium type="homogeneous" name="{name}">{content}{phase}</medium>'

    def through(content, camera=None, light=LAMP + SKY):
        integrator = '<integrator type="volpathmis"><integer name="max_depth" value="16"/></integrator>'
        return scene(content, camera=camera, integrator=integrator, light=light)

    colors = rgb("sigma_t", "0.5, 0.8, 0.3") + rgb("albedo", "0.9, 0.6, 0.8")
    inner = '<shape type="sphere"><float name="radius" value="0.5"/></shape>'
    turned = '<transform name="to_world"><scale value="0.9"/><rotate y="1" angle="30"/></transform>'
    plain = number("sigma_t", 0.8) + number("albedo", 0.9)
    yield "box-isotropic", through(f'<shape type="cube">{turned}{bsdf("null")}{volume(plain, kind="isotropic")}</shape>{inner}')
    for g in (-0.6, 0.3, 0.8):
        yield f"box-hg-{g}", through(f'<shape type="cube">{turned}{bsdf("null")}{volume(plain, g=g)}</shape>{inner}')
    yield "box-colors", through(f'<shape type="cube">{turned}{bsdf("null")}{volume(colors + number("scale", 2))}</shape>{inner}')
    dark = '<spectrum name="sigma_t" value="400:0.3, 550:2, 700:0.5"/>' + number("albedo", 0)
    yield "glass-absorbing", through(f'<shape type="sphere">{bsdf("dielectric")}{volume(rgb("sigma_t", "0.1, 0.5, 0.9") + number("albedo", 0) + number("scale", 2))}</shape>')
    yield "glass-absorbing-samples", through(f'<shape type="sphere">{bsdf("dielectric")}{volume(dark)}</shape>')
    yield "glass-cloudy", through(f'<shape type="sphere">{bsdf("roughdielectric", number("alpha", 0.2))}{volume(plain)}</shape>')
    fog = volume(number("sigma_t", 0.1) + number("albedo", 0.8), "fog")
    hole = f'<shape type="sphere">{bsdf("null")}{fog.replace(chr(34) + "fog" + chr(34), chr(34) + "exterior" + chr(34))}</shape>'
    around = CAMERA.format(film=film(), sampler=SAMPLER).replace("</sensor>", fog + "</sensor>")
    # Of lamps only: through endless fog nothing is seen of an environment, but by Mitsuba, to which it is as far as the scene is wide.
    yield "camera-in-fog", through('<shape type="sphere"/>', around, LAMP)
    yield "camera-in-fog-hole", through(hole + inner, around, LAMP)
    yield "path-sees-none", scene(f'<shape type="sphere">{bsdf("dielectric")}{volume(plain)}</shape>')


def all_scenes():
    for group in (bsdfs, emitters, textures, attributes, shapes, sensors, integrators, media):
        for name, text in group():
            yield f"{group.__name__}/{name}", text
