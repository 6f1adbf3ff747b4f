# gnuplot script; run it from its own folder
if (!exists("png")) png = './ensemble.png'
if (strstrt(GPVAL_TERMINALS, ' pngcairo ')) { set terminal pngcairo size 1000,700 font 'sans,14' } else { set terminal png size 1000,700 }
set encoding utf8
set output png
reset
set title 'Axial strain of a link, 30 rad/s, 15 Hz low pass: the range over settings' noenhanced
set xlabel 't [s]' noenhanced
set ylabel 'axial strain [10⁻⁵]' noenhanced
set grid linetype 1 linecolor rgb '#d8d8d8' linewidth 1
set tics nomirror
set border 3
set key below height 1 noenhanced
set format x '%.6h'
set format y '%.6h'
set xrange [0:0.1]
set yrange [*:*]
plot './ensemble.dat' index 0 using 1:2 with lines linewidth 1.5 linecolor rgb '#0072B2' title 'rigid, decoupled', \
     './ensemble.dat' index 1 using 1:2 with lines linewidth 1.5 linecolor rgb '#0072B2' notitle, \
     './ensemble.dat' index 2 using 1:2 with lines linewidth 1.5 linecolor rgb '#D55E00' title 'ANCF cables', \
     './ensemble.dat' index 3 using 1:2 with lines linewidth 1.5 linecolor rgb '#D55E00' notitle
unset output
