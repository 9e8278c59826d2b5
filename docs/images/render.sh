#!/bin/sh
# Renders the images of docs/guide/scenes.md: sh docs/images/render.sh [PROGRAM], where PROGRAM is toyproof.
# The PNGs are made smaller with optipng, if it is installed.
set -eu
toyproof=${1:-toyproof}
folder=$(dirname "$0")
temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT

# Renders the scene on standard input: render NAME SIZE.
render() {
    cat > "$temporary/scene.toml"
    "$toyproof" render "$temporary/scene.toml" -o "$folder/$1.png" --size "$2" --sampler sobol --samples 64
    if command -v optipng > /dev/null; then
        optipng -quiet -o7 -strip all "$folder/$1.png"
    fi
}

# The surroundings of the images of shapes and materials.
studio='
ambient = [0.12, 0.13, 0.15]
[film]
max_depth = 8
gamma = 2.2
sampler = "sobol"
[camera]
eye = [0.0, 0.9, 4.0]
screen_distance = 3.0
[background]
bottom = [0.9, 0.9, 0.9]
top = [0.15, 0.35, 0.8]
[[light]]
position = [20.0, 50.0, 35.0]
color = [0.95, 0.9, 0.85]
[[plane]]
point = [0.0, 0.0, 0.0]
material = { model = "lambert", color = [0.25, 0.3, 0.2] }
'
matte='material = { model = "lambert", color = [0.8, 0.25, 0.1] }'

# A shape on the floor: shape NAME KEYS.
shape() {
    printf '%s\n[[%s]]\n%s\n%s\n' "$studio" "$1" "$2" "$matte" | render "shape-$1" 240x135
}

# A sphere of a material on a checkered floor: material NAME KEYS.
material() {
    printf '%s\n[[sphere]]\ncenter = [0.0, 1.0, -2.0]\nradius = 1.0\nmaterial = { %s }\n' "$studio" "$2" |
        sed 's/color = \[0.25, 0.3, 0.2\]/&, checker = { color = [0.6, 0.6, 0.5], size = 0.7 }/' |
        render "material-$1" 240x135
}

shape sphere 'center = [0.0, 1.0, -2.0]
radius = 1.0'
shape ellipsoid 'center = [0.0, 0.7, -2.0]
radii = [1.6, 0.7, 0.7]'
shape plane 'point = [-0.8, 0.0, 0.0]
normal = [1.0, 0.7, 0.2]'
shape cylinder 'base = [-0.5, 0.3, -2.5]
axis = [0.6, 0.6, 0.8]
radius = 0.7
height = 1.6'
shape cone 'apex = [0.0, 2.0, -2.0]
axis = [0.0, -1.0, 0.0]
radius = 1.0
height = 2.0'
shape paraboloid 'apex = [0.0, 0.0, -2.0]
axis = [0.0, 1.0, 0.2]
radius = 1.1
height = 1.6'
shape hyperboloid 'center = [0.0, 0.9, -2.0]
waist = 0.5
radius = 1.1
height = 1.8'
shape box 'center = [0.0, 0.65, -2.0]
size = [1.6, 1.3, 1.1]
angle = 35.0'
shape scatter 'corner = [-2.1, 0.0, -4.0]
cells = [6, 2, 3]
spacing = 0.7
radius = [0.15, 0.35]
seed = 7'

material facing 'model = "facing", color = [0.9, 0.4, 0.15]'
material lambert 'model = "lambert", color = [0.8, 0.25, 0.1]'
material diffuse 'model = "diffuse", color = [0.8, 0.25, 0.1]'
material glossy 'model = "glossy", color = [0.8, 0.25, 0.1], exponent = 40.0'
material disney 'model = "disney", color = [0.9, 0.3, 0.1], roughness = 0.25, specular = 0.8, clearcoat = 1.0'
material mirror 'model = "mirror", color = [0.9, 0.85, 0.7]'
material glass 'model = "glass", color = [0.95, 1.0, 0.95], ior = 1.5'
material emitter 'model = "emitter", color = [1.0, 0.8, 0.3]'
material checker 'model = "lambert", color = [0.8, 0.25, 0.1], checker = { color = [0.9, 0.85, 0.7], size = 0.5 }'
material checker-object 'model = "lambert", color = [0.8, 0.25, 0.1], checker = { color = [0.9, 0.85, 0.7], size = 0.4, space = "object" }'
material stripes 'model = "lambert", color = [0.8, 0.25, 0.1], stripes = { color = [0.9, 0.85, 0.7], size = 0.3, direction = [1.0, 2.0, 0.5] }'

# Patterns in the coordinates of their surfaces.
render patterns 480x180 <<SCENE
$studio
[[box]]
center = [-1.3, 0.6, -2.6]
size = [1.2, 1.2, 1.2]
angle = 35.0
material = { model = "lambert", color = [0.8, 0.25, 0.1], checker = { color = [0.9, 0.85, 0.7], size = 0.3, space = "object" } }
[[cylinder]]
base = [-0.35, 0.3, -2.4]
axis = [0.4, 0.8, -0.3]
radius = 0.3
height = 1.2
material = { model = "lambert", color = [0.15, 0.35, 0.7], stripes = { color = [0.9, 0.85, 0.7], size = 0.15, direction = [0.0, 1.0, 0.0], space = "object" } }
[[plane]]
point = [0.6, 0.0, -2.6]
normal = [-1.0, 0.8, 0.3]
material = { model = "lambert", color = [0.3, 0.5, 0.25], checker = { color = [0.9, 0.85, 0.7], size = 0.3, space = "object" } }
SCENE

# The same surfaces with another camera: camera NAME KEYS.
camera() {
    printf '%s\n[[box]]\ncenter = [0.0, 0.7, -2.0]\nsize = [1.4, 1.4, 1.4]\n%s\n' "$studio" "$matte" |
        sed "s/^eye = .*/$2/; /^screen_distance/d" |
        render "camera-$1" 240x135
}

camera eye 'eye = [2.5, 2.0, 2.0]'
camera look-at 'eye = [2.5, 2.0, 2.0]\nlook_at = [0.0, 0.7, -2.0]'
camera roll 'eye = [2.5, 2.0, 2.0]\nlook_at = [0.0, 0.7, -2.0]\nroll = 20.0'
camera fov 'eye = [2.5, 2.0, 2.0]\nlook_at = [0.0, 0.7, -2.0]\nroll = 20.0\nfov = 35.0'

render figures 240x135 <<'SCENE'
[background]
bottom = [0.55, 0.7, 0.9]
top = [0.2, 0.35, 0.7]
[[figure]]
outline = "disk"
center = [-0.55, 0.2]
radius = 0.2
color = [1.0, 0.85, 0.3]
[[figure]]
outline = "wave"
height = -0.25
amplitude = 0.08
frequency = 9.0
color = [0.1, 0.3, 0.45]
[[figure]]
outline = "heart"
center = [0.45, 0.05]
size = 0.28
color = [0.85, 0.15, 0.2]
SCENE

# The first example of docs/guide/scenes.md.
sed -n '/^```toml$/,/^```$/{/^```$/q;/^```/d;p;}' "$folder/../guide/scenes.md" | render example 480x270
