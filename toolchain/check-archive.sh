#!/usr/bin/env bash
# Proves from their object files that the libraries of the target (comp, metrology, embed/c, canopen, node, hal/linux) keep
# their promises: no heap, no exceptions, no work before main, no mutable globals, no C library mathematics in what runs
# in the interrupt (the rooms tables, tick, probe and strokes of comp).
#
#   toolchain/check-archive.sh [BUILD_FOLDER]   default build/host; a Release build
#   toolchain/check-archive.sh --self-test      proves that each kind of offence is found
#
# NM, OBJDUMP and AR name the tools of another target; --self-test also uses CXX.
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"

readonly nm=${NM:-nm} objdump=${OBJDUMP:-objdump} ar=${AR:-ar}

# kind|what it is|extended regular expression for a whole symbol name
readonly symbol_rules=(
  'heap|allocator|(__libc_|_*)?(malloc|calloc|realloc|reallocarray|free|cfree|memalign|aligned_alloc|posix_memalign|valloc|pvalloc|strdup|strndup)(_r)?|_Zn[wa][jmy].*|_Zd[la]Pv.*'
  'exceptions|exception machinery|__cxa_(allocate_exception|free_exception|throw|rethrow|begin_catch|end_catch|init_primary_exception|bad_cast|bad_typeid|call_unexpected|get_exception_ptr|throw_bad_array_new_length)|_Unwind_.*|__gxx_personality.*|__aeabi_unwind_.*|_ZSt[0-9]+__throw_.*|_ZSt9terminatev'
  'guards|guard of a function-local static|__cxa_guard_.*'
  'destructors|destructor registered for the end of the program|__cxa_atexit|__cxa_thread_atexit(_impl)?|__aeabi_atexit|atexit|at_quick_exit'
  'initializers|code run before main|_GLOBAL__(sub_)?[ID]_.*|_Z41__static_initialization_and_destruction_0.*'
)

# Sections with contents, beside the symbols: kind|what it is|extended regular expression
readonly section_rules=(
  'initializers|code run before main|\.(preinit_array|init_array|fini_array|ctors|dtors)(\..*)?'
  'globals|mutable global data|\.(data|bss|tdata|tbss|sdata|sbss)(\..*)?'
)
# Constants that hold addresses live here; nothing writes to them once the program is loaded.
readonly constant_sections='\.data\.rel\.ro(\..*)?'

readonly libm_names='a?cosh?|a?sinh?|a?tanh?|atan2|sincos|sqrt|cbrt|hypot|pow|powi|pow10|exp|exp2|exp10|expm1|log|log2|log10|log1p|logb|ilogb|ldexp|frexp|modf|scalbl?n|erfc?|[lt]gamma|gamma|lgamma_r|j[01n]|y[01n]|floor|ceil|trunc|round|roundeven|l?lround|rint|l?lrint|nearbyint|fabs|fmod|remainder|remquo|drem|copysign|nan|nextafter|nexttoward|nextup|nextdown|fdim|fmax|fmin|fma|significand|fe(clear|get|raise|set|test)except(flag)?|fe[gs]etround|fe[gs]etenv|feholdexcept|feupdateenv'
readonly libm="(__)?($libm_names)[fl]?(_finite)?|__(fpclassify|signbit|isinf|isnan|finite|issignaling)[fl]?"

# split_archive ARCHIVE FOLDER: every member as a file NUMBER/NAME, also where two share a name.
split_archive() {
  local archive=$1 folder=$2 member copies copy number=0
  while read -r copies member; do
    for ((copy = 1; copy <= copies; ++copy)); do
      number=$((number + 1))
      mkdir -p "$folder/$number"
      (cd "$folder/$number" && "$ar" xN "$copy" "$archive" "$member")
    done
  done < <("$ar" t "$archive" | sort | uniq -c)
}

# Both list lines "FILE NAME"; $1 is the folder of the split archive.
list_symbols() {
  (cd "$1" && find . -type f -exec "$nm" -A -a {} + 2> /dev/null) |
    awk '{ split($1, file, ":"); if ($(NF - 1) !~ /^[aN]$/) print substr(file[1], 3), $NF }'
}
list_undefined() {
  (cd "$1" && find . -type f -exec "$nm" -A -u {} + 2> /dev/null) |
    awk '{ split($1, file, ":"); print substr(file[1], 3), $NF }'
}
list_filled_sections() {
  local object
  (cd "$1" && find . -type f -print) | while read -r object; do
    "$objdump" -h "$1/$object" |
      awk -v object="${object#./}" '$1 ~ /^[0-9]+$/ && $3 !~ /^0+$/ { print object, $2 }'
  done
}

# matches REGEX: those lines "FILE NAME" of the input whose NAME matches as a whole.
matches() {
  awk -v rule="^($1)\$" '$2 ~ rule'
}

# report KIND WHAT LINES: prints what was looked for and each offender; adds to the counters.
report() {
  local kind=$1 what=$2 lines=$3 object symbol
  checks=$((checks + 1))
  if [ -z "$lines" ]; then
    printf '  ok    %-13s no %s\n' "$kind" "$what"
    return
  fi
  while read -r object symbol; do
    offenders=$((offenders + 1))
    printf '  FOUND %-13s %s: %s in %s\n' "$kind" "$what" "$(c++filt "$symbol")" "${object#*/}"
  done <<< "$lines"
}

# realtime_members SPLIT_FOLDER OBJECT_FOLDER...: those members whose bytes equal an object of these rooms.
realtime_members() {
  local object member
  find "${@:2}" -type f -name '*.o*' 2> /dev/null | grep -v "/$background_source\\.o" | while read -r object; do
    for member in "$1"/*/"$(basename "$object")"; do
      [ -f "$member" ] && cmp -s "$object" "$member" && printf '%s\n' "${member#"$1"/}"
    done
  done | sort -u
}

check_realtime() {
  local folder=$1 members source
  members=$(realtime_members "$@")
  for source in $(sources '*.cpp' "${realtime_sources[@]}"); do
    [ "$(basename "$source")" = "$background_source" ] || grep -q "/$(basename "$source")\\.o" <<< "$members" ||
      die "$source has no object in $archive: build it first."
  done
  if [ -z "$members" ]; then
    [ -z "$(sources '*.hpp' "${realtime_sources[@]}")" ] ||
      die "${realtime_sources[*]}: there are headers but no object in $archive, so nothing about it can be proved."
    return
  fi
  printf '  in the interrupt: %s of the objects\n' "$(wc -l <<< "$members")"
  report mathematics 'C library mathematics in the interrupt' \
    "$(list_undefined "$folder" | awk 'NR == FNR { realtime[$1]; next } $1 in realtime' <(printf '%s\n' "$members") - |
      matches "$libm")"
}

# check ARCHIVE [REALTIME_OBJECT_FOLDER...]: false if there is an offender.
check() {
  local archive=$1 realtime=("${@:2}") folder rule kind what pattern symbols filled
  [ -f "$archive" ] || die "there is no archive $archive: build it first."
  archive=$(realpath "$archive")
  folder=$(mktemp -d "$work/split.XXXXXX")
  split_archive "$archive" "$folder"
  symbols=$(list_symbols "$folder")
  filled=$(list_filled_sections "$folder" | awk -v constant="^($constant_sections)\$" '$2 !~ constant')
  [ -n "$symbols" ] || die "$archive contains no symbol at all, so nothing can be proved."
  checks=0 offenders=0
  printf '%s: %s objects\n' "${archive#"$PWD"/}" "$(find "$folder" -type f | wc -l)"
  for rule in "${symbol_rules[@]}"; do
    IFS='|' read -r kind what pattern <<< "$rule"
    report "$kind" "$what" "$(matches "$pattern" <<< "$symbols" | sort -u)"
  done
  for rule in "${section_rules[@]}"; do
    IFS='|' read -r kind what pattern <<< "$rule"
    report "$kind" "$what (section)" "$(matches "$pattern" <<< "$filled" | sort -u)"
  done
  [ ${#realtime[@]} = 0 ] || check_realtime "$folder" "${realtime[@]}"
  printf '  %s checks, %s offenders\n' "$checks" "$offenders"
  [ "$offenders" = 0 ]
}

# try_source KIND FILE_NAME FLAGS: compiles the program text on the input and expects an offence of KIND,
# or none where KIND is "clean".
try_source() {
  local expected=$1 name=$2 folder output status=0
  shift 2
  folder=$(mktemp -d "$work/try.XXXXXX")
  mkdir -p "$folder/objects/realtime" "$folder/objects/other"
  cat > "$folder/$name.cpp"
  local place=$folder/objects/other
  [[ $name == realtime_* ]] && place=$folder/objects/realtime
  "$cxx" -std=c++17 -O2 -w "$@" -c "$folder/$name.cpp" -o "$place/$name.cpp.o"
  (cd "$folder" && "$ar" rc try.a "$place/$name.cpp.o")
  output=$(check "$folder/try.a" "$folder/objects/realtime") || status=$?
  if [ "$expected" = clean ]; then
    [ "$status" = 0 ] || die "self-test: the clean object $name was refused: $output"
  elif [ "$status" != 1 ] || ! grep -q "FOUND $expected .* in $name\\.cpp\\.o" <<< "$output"; then
    die "self-test: the offence \"$expected\" in $name was not found: $output"
  fi
  tries=$((tries + 1))
}

self_test() {
  local none=(-fno-exceptions -fno-rtti -fno-threadsafe-statics)
  need "$cxx"
  realtime_sources=("$work/no-sources")
  tries=0
  try_source clean plain "${none[@]}" <<< '
    struct Base { virtual int f() const = 0; };
    struct Derived final : Base { int f() const override { return 1; } };
    extern const Derived derived; const Derived derived{};
    extern const char* const names[]; const char* const names[] = {"free", "sin"};
    int free_nodes(const Base& b) { return b.f() + derived.f(); }'
  try_source clean math_elsewhere "${none[@]}" <<< '
    #include <cmath>
    double f(double x) { return std::sin(x); }'
  try_source clean realtime_plain "${none[@]}" <<< 'double f(double x) { return 2.0 * x; }'
  local call
  for call in 'malloc(1)' 'calloc(1, 1)' 'realloc(p, 2)' '(free(p), p)' 'aligned_alloc(16, 16)' \
    '(posix_memalign(&p, 16, 16), p)'; do
    try_source heap c_heap "${none[@]}" <<< "
      #include <cstdlib>
      void* f(void* p) { return $call; }"
  done
  try_source heap new_one "${none[@]}" <<< 'int* f() { return new int; }'
  try_source heap new_array "${none[@]}" <<< 'int* f(unsigned n) { return new int[n]; }'
  try_source heap delete_one "${none[@]}" <<< 'void f(int* p) { delete p; }'
  try_source heap delete_array "${none[@]}" <<< 'void f(int* p) { delete[] p; }'
  try_source heap own_new "${none[@]}" <<< '
    #include <cstddef>
    alignas(16) static char pool[64];
    void* operator new(std::size_t) { return pool; }'
  try_source heap deleting_destructor "${none[@]}" <<< '
    struct Base { virtual ~Base(); }; Base::~Base() = default;'
  try_source exceptions throwing <<< 'void f() { throw 1; }'
  try_source exceptions catching <<< 'void g(); int f() { try { g(); } catch (...) { return 1; } return 0; }'
  try_source exceptions unwinding <<< 'struct A { ~A(); }; void g(); void f() { A a; g(); }'
  try_source exceptions library_throw "${none[@]}" <<< '
    #include <array>
    int f(const std::array<int, 3>& a, unsigned i) { return a.at(i); }'
  try_source guards local_static -fno-exceptions <<< 'int g(); int f() { static const int i = g(); return i; }'
  try_source destructors global_object "${none[@]}" <<< 'struct A { ~A(); }; A a;'
  try_source initializers global_start "${none[@]}" <<< 'int g(); const int i = g(); const int& f() { return i; }'
  try_source initializers constructor_attribute "${none[@]}" <<< 'void g(); [[gnu::constructor]] void f() { g(); }'
  try_source globals initialized "${none[@]}" <<< 'int counter = 3; int f() { return ++counter; }'
  try_source globals zeroed "${none[@]}" <<< 'static int counter; int f() { return ++counter; }'
  try_source globals thread_local "${none[@]}" <<< 'thread_local int counter; int f() { return ++counter; }'
  try_source mathematics realtime_sine "${none[@]}" <<< '
    #include <cmath>
    float f(float x) { return std::sin(x); }'
  local function
  for function in {sin,cos,tan,asin,atan2,sincos,sinh,sqrt,cbrt,hypot,pow,exp,log,floor,ceil,trunc}{,f,l} \
    {round,lround,llround,rint,lrint,llrint,nearbyint,fmod,remainder,modf,frexp,ldexp,fma,fmin}{,f,l}; do
    try_source mathematics "realtime_$function" "${none[@]}" -fno-builtin -x c++ <<< "
      extern \"C\" void $function(); void f() { $function(); }"
  done
  printf 'self-test: %s small programs judged rightly\n' "$tries"
}

need "$nm" "$objdump" "$ar" c++filt
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
realtime_sources=(comp/tables comp/tick comp/probe comp/strokes)
# Only the background of a grinder calls it.
background_source=spectral_line.cpp
cxx=${CXX:-g++}
case "${1:-}" in
  -h | --help) usage ;;
  --self-test) self_test ;;
  -*) die "unknown argument \"$1\" (try --help)." ;;
  *)
    build=${1:-build/host}
    objects=$build/comp/CMakeFiles/volcomp_comp.dir
    check "$build/comp/libvolcomp_comp.a" "$objects/tables" "$objects/tick" "$objects/probe" "$objects/strokes" ||
      die "the library comp breaks a promise, see FOUND above."
    for library in comp/libvolcomp_metrology firmware/embed/c/libvolcomp_c firmware/canopen/libvolcomp_canopen firmware/node/libvolcomp_node \
      hal/libvolcomp_hal_linux; do
      check "$build/$library.a" || die "$library breaks a promise, see FOUND above."
    done
    ;;
esac
