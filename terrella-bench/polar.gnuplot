$plot0_0 << EOD
1 9.779185689620874
3.3259729244880645 8.80521888759885
3.343508495251259 8.80521888759885
3.4249576102535055 8.80521888759885
3.373366693384153 8.80521888759885
EOD
$plot0_1 << EOD
2.5045657666695575 0.8166308019814231
EOD
$plot0_2 << EOD
2.60982732602965 0.40254565439984963
EOD
$plot0_3 << EOD
7.197245729584189 0.40254565439984963
EOD
$plot0_4 << EOD
2.871194108377988 0.3680969341115516
EOD
$plot0_5 << EOD
1.5741348712716616 9.83783720655093
1.5572040518608001 13.697061317407966
1.5601661278508563 9.183391126880359
1.696426259397902 1.809540375601861
2.151203349945483 1.6338503259499533
1.6826033191918504 6.874892685736376
EOD
$plot0_6 << EOD
2.194903143777554 4.633792446857541
2.138162132443044 5.982364737492378
2.14399306938418 5.915818576476222
2.4438634828516292 1.5936600240700942
2.973884076980579 1.3952198654976267
2.2140657202767926 3.3378712606502585
EOD
$plot0_7 << EOD
1.2891329272877365 8.580919815295191
3.5137465765707754 7.212030233291845
3.5172237115465936 7.212030233291845
3.663740554450696 7.212030233291845
3.577474094432877 7.212030233291845
EOD
set terminal pngcairo size 1240,460 font "DejaVu Sans,9"
set output "polar.png"
set multiplot layout 1,2
set grid
set key outside bottom center horizontal
set bmargin 8
set offsets graph 0.03, graph 0.03, graph 0.03, graph 0
set title "error in the pole band beside time, inscribed, over the pole" noenhanced
set xlabel "ratio_plain, time / plain" noenhanced
set ylabel "rms_pole, 8-bit levels" noenhanced
unset logscale x
unset logscale y
set xrange [*:*]
set xtics autofreq
set yrange [0:*]
set ytics autofreq
plot $plot0_0 using 1:2 with points lt 1 pt 4 title "sphere: plain" noenhanced, \
  $plot0_1 using 1:2 with points lt 2 pt 5 title "globe: vertex" noenhanced, \
  $plot0_2 using 1:2 with points lt 3 pt 6 title "globe: auto" noenhanced, \
  $plot0_3 using 1:2 with points lt 4 pt 7 title "globe: exact" noenhanced, \
  $plot0_4 using 1:2 with points lt 5 pt 8 title "globe: auto, full grid" noenhanced, \
  $plot0_5 using 1:2 with points lt 6 pt 9 title "sphere: paper" noenhanced, \
  $plot0_6 using 1:2 with points lt 7 pt 10 title "globe: paper" noenhanced, \
  $plot0_7 using 1:2 with points lt 8 pt 11 title "sphere: exact" noenhanced
set title "error in the pole band beside time, 1500 km, beside the pole" noenhanced
set xlabel "ratio_plain, time / plain" noenhanced
set ylabel "rms_pole, 8-bit levels" noenhanced
unset logscale x
unset logscale y
set xrange [*:*]
set xtics autofreq
set yrange [0:*]
set ytics autofreq
unset logscale
set xrange [0:1]
set yrange [0:1]
plot NaN notitle
set xrange [*:*]
unset multiplot
