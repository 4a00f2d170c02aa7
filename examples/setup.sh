# Sourced by examples/run.sh and tests/run.sh: the Debian packages that photongrid needs, and how they get there.

# What builds and runs the program with the backends cpu and serial; then what each module needs besides: the window, and
# the backends gl and vulkan with drivers that need no GPU.
base_packages=(
  g++ cmake ninja-build
  libtbb-dev libhwy-dev
  libglm-dev libcli11-dev nlohmann-json3-dev libjpeg62-turbo-dev libopenexr-dev libpng-dev libstb-dev
  libpugixml-dev zlib1g-dev
)
window_packages=(pkg-config libgl-dev libopengl-dev libglfw3-dev libimgui-dev)
gl_packages=(pkg-config libgl-dev libopengl-dev libegl-dev libegl1 libegl-mesa0 libgl1-mesa-dri)
vulkan_packages=(libvulkan-dev mesa-vulkan-drivers glslang-dev glslang-tools spirv-tools)
# The program with all modules.
# shellcheck disable=SC2034 # used by the scripts that source this one
program_packages=("${base_packages[@]}" "${window_packages[@]}" "${gl_packages[@]}" "${vulkan_packages[@]}")
# What the benches need besides: those that tests/run.sh runs, and the others. POV-Ray only where pictures are compared with its.
# shellcheck disable=SC2034
smoke_packages=(libbenchmark-dev gnuplot-nox python3)
# shellcheck disable=SC2034
bench_packages=(libcgal-dev libflann-dev libnanoflann-dev xvfb xdotool)
# Packages of gl that later Debians no longer have; CMake does without.
optional_packages=(libosmesa6-dev)

# missing_of PACKAGE...: those that are not installed.
missing_of() {
  local package
  for package in "$@"; do
    dpkg-query --show --showformat '${db:Status-Status}\n' "$package" 2>/dev/null | grep -q '^installed$' || echo "$package"
  done
}

# require_packages yes|no PACKAGE...: installs what is missing of the packages and of optional_packages; with "no", only
# says what is missing, and fails.
require_packages() {
  local install=$1 missing optional
  shift
  if ! command -v dpkg-query >/dev/null; then
    echo "This is no Debian system: not looking for packages. Under Debian these are needed: $*" >&2
    return 0
  fi
  # No <(...), which needs /proc: chroots may lack it.
  read -r -a missing <<<"$(missing_of "$@" | tr '\n' ' ')"
  read -r -a optional <<<"$(missing_of "${optional_packages[@]}" | tr '\n' ' ')"
  if ((${#missing[@]} + ${#optional[@]} == 0)); then
    return 0
  fi
  echo "Missing packages: ${missing[*]}${optional[*]:+ (optional: ${optional[*]})}" >&2
  if [[ $install == no ]]; then
    if ((${#missing[@]} == 0)); then
      return 0
    fi
    echo "Install them: apt-get install ${missing[*]}" >&2
    return 1
  fi
  local as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      if ((${#missing[@]} == 0)); then
        return 0
      fi
      echo "Not root, and there is no sudo. As root: apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing them with apt-get (--no-install only lists them)." >&2
  "${as_root[@]}" apt-get update -qq
  local package
  for package in "${optional[@]}"; do
    if [[ -n $(apt-cache madison "$package" 2>/dev/null) ]]; then
      missing+=("$package")
    fi
  done
  if ((${#missing[@]} > 0)); then
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
  fi
}
