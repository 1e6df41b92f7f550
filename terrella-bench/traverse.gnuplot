$plot0_0 << EOD
24502.413223140495 60.38670597910023
EOD
$plot0_1 << EOD
34136.28099173554 58.700782092772386
EOD
$plot0_2 << EOD
19861.54356846473 73.75898908376016
EOD
$plot0_3 << EOD
32979.186721991704 61.29066535883603
EOD
$plot1_0 << EOD
32.90683 4.189784490665287
EOD
$plot1_1 << EOD
97.743092 1.5525364562361694
EOD
$plot1_2 << EOD
31.978183 3.0875785067323145
EOD
$plot1_3 << EOD
33.608219 1.4961554240675434
EOD
set terminal pngcairo size 1240,460 font "DejaVu Sans,9"
set output "traverse.png"
set multiplot layout 1,2
set grid
set key outside bottom center horizontal
set bmargin 8
set offsets graph 0.03, graph 0.03, graph 0.03, graph 0
set title "what is drawn and not needed" noenhanced
set xlabel "triangles, mean" noenhanced
set ylabel "needless_triangles, %" noenhanced
unset logscale x
unset logscale y
set xrange [*:*]
set xtics autofreq
set yrange [0:*]
set ytics autofreq
plot $plot0_0 using 1:2 with points lt 1 pt 4 title "orbit_to_street" noenhanced, \
  $plot0_1 using 1:2 with points lt 2 pt 5 title "pole_crossing" noenhanced, \
  $plot0_2 using 1:2 with points lt 3 pt 6 title "antimeridian_crossing" noenhanced, \
  $plot0_3 using 1:2 with points lt 4 pt 7 title "horizon_skim" noenhanced
set title "lag behind the settled picture" noenhanced
set xlabel "time, ms, median" noenhanced
set ylabel "rms_lag, 8-bit levels" noenhanced
unset logscale x
unset logscale y
set xrange [*:*]
set xtics autofreq
set yrange [0:*]
set ytics autofreq
plot $plot1_0 using 1:2 with points lt 1 pt 4 title "orbit_to_street" noenhanced, \
  $plot1_1 using 1:2 with points lt 2 pt 5 title "pole_crossing" noenhanced, \
  $plot1_2 using 1:2 with points lt 3 pt 6 title "antimeridian_crossing" noenhanced, \
  $plot1_3 using 1:2 with points lt 4 pt 7 title "horizon_skim" noenhanced
unset multiplot
