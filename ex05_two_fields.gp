# gnuplot script; run it from its own folder
if (!exists("png")) png = './ex05_two_fields.png'
if (strstrt(GPVAL_TERMINALS, ' pngcairo ')) { set terminal pngcairo size 3000,700 font 'sans,14' } else { set terminal png size 3000,700 }
set encoding utf8
set output png
set multiplot layout 1,3
reset
set title 'a) u_1 = q sin(pi x/L)' noenhanced
set xlabel 'x [m]' noenhanced
set ylabel 'u_1 [m]' noenhanced
set grid linetype 1 linecolor rgb '#d8d8d8' linewidth 1
set tics nomirror
set border 3
unset key
set format x '%.6h'
set format y '%.6h'
set xrange [*:*]
set yrange [*:*]
plot './ex05_two_fields.dat' index 0 using 1:2 with lines linewidth 1.5 linecolor rgb '#0072B2' notitle
reset
set title 'b) u_2 = q sin(2 pi x/L)' noenhanced
set xlabel 'x [m]' noenhanced
set ylabel 'u_2 [m]' noenhanced
set grid linetype 1 linecolor rgb '#d8d8d8' linewidth 1
set tics nomirror
set border 3
unset key
set format x '%.6h'
set format y '%.6h'
set xrange [*:*]
set yrange [*:*]
plot './ex05_two_fields.dat' index 1 using 1:2 with lines linewidth 1.5 linecolor rgb '#D55E00' notitle
reset
set title 'c) curvatures for the same q' noenhanced
set xlabel 'x [m]' noenhanced
set ylabel '|d^2u/dx^2| [1/m]' noenhanced
set grid linetype 1 linecolor rgb '#d8d8d8' linewidth 1
set tics nomirror
set border 3
set key below height 1 noenhanced
set format x '%.6h'
set format y '%.6h'
set xrange [*:*]
set yrange [*:*]
plot './ex05_two_fields.dat' index 2 using 1:2 with lines linewidth 1.5 linecolor rgb '#0072B2' title 'of u_1', \
     './ex05_two_fields.dat' index 3 using 1:2 with lines linewidth 1.5 linecolor rgb '#D55E00' title 'of u_2'
unset multiplot
unset output
