# Names of the examples of examples/run, and the page of their pictures. Other scripts source this file.
# pictures.tsv lists the pictures and films of each example in their order, with a sentence for each.
gallery_list=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/pictures.tsv

# Examples that are built by default: the thesis. Then studies and designs.
chapters=(pendulum robot_arm cantilever tracked_vehicle link_from_fe track_stress)
stages=("${chapters[@]}" chain_study vehicle_study identify lighter_link)

# Time of each example from its start to its last picture, if the previous examples are built, on two cores [s]. These
# times are used only to estimate the remaining time.
declare -A seconds=([pendulum]=15 [robot_arm]=90 [cantilever]=25 [chain_study]=30 [tracked_vehicle]=150 [link_from_fe]=25 [track_stress]=120 [vehicle_study]=50 [identify]=45 [lighter_link]=40)

declare -A shows=(
  [pendulum]="A rod on a pin, released from the horizontal: energy drift and constraint violation after two seconds."
  [robot_arm]="The flexible robot arm of Chapter 2: shapes, deflections, and energies under several formulations."
  [cantilever]="The clamped beam of Chapter 2 under a moment at its tip, up to a full circle."
  [chain_study]="A study of 100 runs: stiffness of penalty pins, step, integrator, and the cost of accuracy."
  [tracked_vehicle]="The tracked vehicle of Chapter 3 under five formulations of its pins."
  [link_from_fe]="A link of 8300 nodes from a finite element program, reduced and on its pins."
  [track_stress]="Stresses of the track links of Chapter 4: decoupled, and by flexible links of several formulations."
  [identify]="Stiffness and damping of a mount from a noisy record of the arm on it, by gradients, under four formulations."
  [lighter_link]="The lightest driven link whose stress stays bounded, by gradients, under four formulations."
  [vehicle_study]="A study of 24 vehicles whose preload and friction are drawn at random: forces in a pin, and the distance travelled."
)

# command_of NAME OUT [VIEWER]: the program NAME and its options. With a VIEWER, some programs write a film.
command_of() {
  local film=${3:+ --viewer $3}
  case $1 in
    robot_arm | cantilever) echo "$1 --case all --out $2/$1$film" ;;
    tracked_vehicle | track_stress) echo "$1 --figure all --out $2/$1$film" ;;
    identify | lighter_link) echo "$1 --out $2/$1" ;;
    pendulum) echo "$1 $2/$1" ;;
    chain_study | vehicle_study) echo "$1 --threads $(nproc) --out $2/$1" ;;
    *) echo "$1" ;;
  esac
}

# sentences_of NAME: file and sentence of each picture and film of the example, separated by a tab.
sentences_of() { awk -F '\t' -v name="$1" '$1 == name { print $2 "\t" $3 }' "$gallery_list"; }

# pictures_of NAME OUT: those whose file exists in OUT/NAME.
pictures_of() {
  local file sentence
  while IFS=$'\t' read -r file sentence; do
    [ ! -f "$2/$1/$file" ] || printf '%s\t%s\n' "$file" "$sentence"
  done < <(sentences_of "$1")
}

# unlisted_of NAME OUT: pictures and films in OUT/NAME without a sentence.
unlisted_of() {
  LC_ALL=C comm -13 <(sentences_of "$1" | cut -f 1 | LC_ALL=C sort) \
    <(cd "$2/$1" && find . -type f \( -name '*.png' -o -name '*.svg' -o -name 'film*.html' \) | sed 's|^\./||' | LC_ALL=C sort)
}

# left DONE ALL ELAPSED: the remaining time if DONE of ALL expected seconds took ELAPSED.
left() {
  local expected=$(($2 - $1))
  (($1 == 0)) || expected=$((expected * $3 / $1))
  if ((expected < 90)); then
    echo "about $expected s left"
  else
    echo "about $(((expected + 30) / 60)) min left"
  fi
}

escaped() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g; s/"/\&quot;/g' <<< "$1"; }

# write_index OUT: writes OUT/index.html with the listed pictures and films below OUT, and prints the names of others. The
# page is written to a temporary file and moved, so it is never incomplete.
write_index() {
  local out=$1 page=$1/index.html.part name file path sentence films
  mkdir -p "$out"
  {
    cat << 'HEAD'
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>polybody: examples</title>
<style>
  body { font: 16px/1.5 sans-serif; margin: 2em auto; max-width: 80em; padding: 0 1em; color: #222; }
  code { background: #f2f2f2; padding: .2em .4em; }
  .figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(24em, 1fr)); gap: 1.5em; }
  figure { margin: 0; } img { width: 100%; border: 1px solid #ddd; } figcaption { font-size: 90%; }
  .film { grid-column: 1 / -1; margin: 0; } .film a { font-weight: 600; }
</style>
<h1>polybody: examples</h1>
HEAD
    for name in "${stages[@]}"; do
      [ -d "$out/$name" ] || continue
      echo "<h2>$name</h2>"
      echo "<p>$(escaped "${shows[$name]}")</p>"
      # If the example has films, its command includes the viewer.
      films=$(pictures_of "$name" "$out" | grep '^film' || true)
      echo "<p><code>build/examples/examples/$(escaped "$(command_of "$name" "$out" "${films:+build/examples/polybody_viewer.html}")")</code></p>"
      echo '<div class="figures">'
      while IFS=$'\t' read -r file sentence; do
        path=$(escaped "$name/$file") sentence=$(escaped "$sentence")
        case $file in
          *.html) echo "<p class=\"film\"><a href=\"$path\">&#9654; Film</a>. $sentence</p>" ;;
          *)
            echo "<figure><a href=\"$path\"><img loading=\"lazy\" src=\"$path\" alt=\"$sentence\"></a>"
            echo "<figcaption>$sentence</figcaption></figure>" ;;
        esac
      done < <(pictures_of "$name" "$out")
      echo '</div>'
      while IFS= read -r file; do
        echo "Not on the page, because ${gallery_list##*/} has no sentence for it: $out/$name/$file" >&2
      done < <(unlisted_of "$name" "$out")
    done
    echo '</html>'
  } > "$page"
  mv "$page" "$out/index.html"
}
