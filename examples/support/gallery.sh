# Names and captions of the examples of examples/run, and the page of their pictures. Other scripts source this file.

# Examples that are built by default: the thesis. Then studies and designs.
chapters=(pendulum robot_arm cantilever tracked_vehicle link_from_fe track_stress)
stages=("${chapters[@]}" chain_study vehicle_study identify lighter_link)

# Time of each example from its start to its last picture, if the previous examples are built, on two cores [s]. These
# times are used only to estimate the remaining time.
declare -A seconds=([pendulum]=15 [robot_arm]=90 [cantilever]=25 [chain_study]=30 [tracked_vehicle]=150 [link_from_fe]=25 [track_stress]=120 [vehicle_study]=50 [identify]=45 [lighter_link]=40)

declare -A shows=(
  [pendulum]="A rod on a pin, in 22 lines: time, energy drift [J] and constraint violation [m] after two seconds."
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
    chain_study | vehicle_study) echo "$1 --threads $(nproc) --out $2/$1" ;;
    *) echo "$1" ;;
  esac
}

films_of() { find "$1" -type f -name 'film*.html' 2> /dev/null | sort; }

pictures_of() { find "$1" -type f \( -name '*.png' -o -name '*.svg' \) 2> /dev/null | sort; }

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

# caption_of PICTURE: the title in the script of the same name, or the words of the picture's name.
caption_of() {
  local script=${1%.*}.gp title=
  [ ! -r "$script" ] || title=$(sed -n "s/^set title '\(.*\)' noenhanced\$/\1/p" "$script" | head -n 1 | sed "s/''/'/g")
  local name=$(basename "${1%.*}" | tr _ ' ')
  echo "${title:-${name^}}"
}

# title_of FILM: the title of the film's page, unchanged.
title_of() { grep -m 1 -ao '<title>[^<]*' "$1" | sed 's/^<title>//; s/ · film$//'; }

# write_index OUT: writes OUT/index.html with all pictures and films below OUT. The page is written to a temporary file
# and moved, so it is never incomplete.
write_index() {
  local out=$1 page=$1/index.html.part name picture path caption films
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
  .film a { font-weight: 600; }
</style>
<h1>polybody: examples</h1>
HEAD
    for name in "${stages[@]}"; do
      [ -d "$out/$name" ] || continue
      echo "<h2>$name</h2>"
      echo "<p>$(escaped "${shows[$name]}")</p>"
      # If the example has films, its command includes the viewer.
      films=$(films_of "$out/$name")
      echo "<p><code>build/examples/examples/$(escaped "$(command_of "$name" "$out" "${films:+build/examples/polybody_viewer.html}")")</code></p>"
      while IFS= read -r picture; do
        path=$(escaped "${picture#"$out"/}")
        echo "<p class=\"film\"><a href=\"$path\">&#9654; $(title_of "$picture")</a></p>"
      done < <([ -z "$films" ] || echo "$films")
      echo '<div class="figures">'
      while IFS= read -r picture; do
        path=$(escaped "${picture#"$out"/}")
        caption=$(escaped "$(caption_of "$picture")")
        echo "<figure><a href=\"$path\"><img loading=\"lazy\" src=\"$path\" alt=\"$caption\"></a>"
        echo "<figcaption>$caption</figcaption></figure>"
      done < <(pictures_of "$out/$name")
      echo '</div>'
    done
    echo '</html>'
  } > "$page"
  mv "$page" "$out/index.html"
}
