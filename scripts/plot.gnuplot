# The picture that scripts/plot draws: left the path in the plane, right the columns over time.
# Runs in a folder with `settings` (which columns there are, and their ranges), N.dat and N.ends.
set encoding utf8
load 'settings'

# Columns of N.dat, by their quantity: t x y x_reference y_reference gamma phi theta, in SI.
array low[8] = [t_low, x_low, y_low, x_reference_low, y_reference_low, gamma_low, phi_low, theta_low]
array high[8] = [t_high, x_high, y_high, x_reference_high, y_reference_high, gamma_high, phi_high, \
                 theta_high]
array symbol[8] = ['t', 'x', 'y', 'reference', '', 'γ', 'φ', 'θ'] # one entry for both references
has(c) = low[c] <= high[c]
is_reference(c) = c == 4 || c == 5

# Colours that are told apart with any colour vision (Okabe and Ito's palette).
array palette[7] = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#000000']
# Of two equal lines the lower one is wider, so that both are seen.
under(f) = 2 + 1.3 * min(files - f, 3)
cycle(i) = palette[(i - 1) % 7 + 1]
array colour[8] = ['', '#0072b2', '#d55e00', '#d0d0d0', '#d0d0d0', '#404040', '#009e73', '#cc79a7']
# A reference is a pale band under the lines that follow it.
reference_colour = '#d0d0d0'
reference_width = 6

max(a, b) = a > b ? a : b
min(a, b) = a < b ? a : b
size_of(c) = max(abs(low[c]), abs(high[c]))

# A length's unit and how many of it make a metre, by the largest length drawn.
length_unit(m) = m < 1e-4 ? 'µm' : m < 1e-2 ? 'mm' : m < 1 ? 'cm' : m < 1e4 ? 'm' : 'km'
per_metre(m) = m < 1e-4 ? 1e6 : m < 1e-2 ? 1e3 : m < 1 ? 1e2 : m < 1e4 ? 1 : 1e-3

# Width of a range; what is constant but for rounding still gets one that is not empty.
width(a, b) = b - a > 1e-9 * max(abs(a), abs(b)) + 1e-15 ? b - a \
            : max(abs(a), abs(b)) > 1e-15 ? max(abs(a), abs(b)) : 1

# The distance of tics that gives about `count` of them over a range this wide: 1, 2 or 5 times 10^n.
tic_step(range, count) = tic_round(1.0 * range / count)
tic_round(step) = tic_nice(step / 10.0**floor(log10(step))) * 10.0**floor(log10(step))
tic_nice(step) = step < 1.5 ? 1 : step < 3.5 ? 2 : step < 7.5 ? 5 : 10

# The panels over time: the columns that share one, its label, its unit as a factor.
array panel[7]
array label[7]
array factor[7]
panels = 0
lengths(columns) = max(size_of(int(word(columns, 1))), \
                       words(columns) > 1 ? size_of(int(word(columns, 2))) : 0)
if (has(1)) {
  x_columns = has(4) ? '4 2' : '2'
  y_columns = has(5) ? '5 3' : '3'
  # x and y share a panel, unless one would be a flat line beside the other.
  wide = max(high[2] - low[2], high[3] - low[3])
  narrow = min(high[2] - low[2], high[3] - low[3])
  if (files > 1 || (wide > 50 * narrow && narrow > 1e-9 * wide)) {
    panel[1] = x_columns; panel[2] = y_columns; panels = 2
  } else {
    panel[1] = (has(4) ? '4 ' : '').(has(5) ? '5 ' : '').'2 3'; panels = 1
  }
  do for [p = 1:panels] {
    largest = 0
    do for [c in panel[p]] { largest = max(largest, size_of(int(c))) }
    factor[p] = per_metre(largest)
    label[p] = (panel[p] eq x_columns ? 'x' : panel[p] eq y_columns ? 'y' : 'x, y').\
               ' ('.length_unit(largest).')'
  }
  if (has(6)) { panels = panels + 1; panel[panels] = '6'; label[panels] = 'γ (rad)'; factor[panels] = 1 }
  angles = (has(7) ? '7 ' : '').(has(8) ? '8' : '')
  if (files > 1) {
    do for [c in angles] {
      panels = panels + 1; panel[panels] = c
      label[panels] = symbol[int(c)].' (°)'; factor[panels] = 180 / pi
    }
  } else { if (words(angles) > 0) {
    panels = panels + 1; panel[panels] = angles
    label[panels] = (words(angles) > 1 ? 'φ, θ' : symbol[int(word(angles, 1))]).' (°)'
    factor[panels] = 180 / pi
  }}
}

# The sheet, in pixels; everything below is placed in fractions of it.
sheet_width = panels > 0 ? 1200 : 640
reference = has(4) && has(5)
legend_rows = files > 1 ? files + 1 + reference : 1
sheet_height = max(620, 130 + 130 * panels) + 20 * (legend_rows - 1)
if (format eq 'png') {
  set terminal pngcairo size sheet_width, sheet_height font 'DejaVu Sans,11' rounded \
      background '#ffffff'
} else {
  set terminal svg size sheet_width, sheet_height font 'DejaVu Sans,Verdana,Helvetica,sans-serif,13' \
      rounded background '#ffffff'
}
set output 'picture'
horizontal(pixels) = 1.0 * pixels / sheet_width
vertical(pixels) = 1 - 1.0 * pixels / sheet_height # from the top

# The SVG terminal's points are larger than the PNG terminal's.
ring = format eq 'svg' ? 1.2 : 1.9
dot = format eq 'svg' ? 0.6 : 0.9

set border 3 linecolor rgb '#404040'
set tics nomirror out textcolor rgb '#202020' scale 0.6
set grid linecolor rgb '#e4e4e4' linewidth 1 linetype 1
set format '%.8g'
set key noenhanced
title_text = files > 1 ? '' : name[1]

set multiplot
set label 1 title_text noenhanced at screen 0.5, screen vertical(24) center font ',16'

# The path, to scale: the shorter range is widened until both axes have one scale.
bottom_pixels = sheet_height - 60
top_pixels = 48 + 20 * legend_rows
left_pixels = 85
right_pixels = panels > 0 ? 555 : sheet_width - 30
set lmargin at screen horizontal(left_pixels)
set rmargin at screen horizontal(right_pixels)
set bmargin at screen vertical(bottom_pixels)
set tmargin at screen vertical(top_pixels)

x_min = has(4) ? min(low[2], low[4]) : low[2]
x_max = has(4) ? max(high[2], high[4]) : high[2]
y_min = has(5) ? min(low[3], low[5]) : low[3]
y_max = has(5) ? max(high[3], high[5]) : high[3]
largest = max(max(abs(x_min), abs(x_max)), max(abs(y_min), abs(y_max)))
scale = per_metre(largest)
aspect = 1.0 * (right_pixels - left_pixels) / (bottom_pixels - top_pixels)
extent = max(x_max - x_min, (y_max - y_min) * aspect)
half = 0.54 * scale * (extent > 1e-9 * largest ? extent : max(largest, 1e-3))
x_middle = scale * (x_min + x_max) / 2
y_middle = scale * (y_min + y_max) / 2
set xrange [x_middle - half:x_middle + half]
set yrange [y_middle - half / aspect:y_middle + half / aspect]
set xtics tic_step(2 * half, 6)
set ytics tic_step(2 * half, 6)
set xlabel 'x ('.length_unit(largest).')' offset 0, 0.3
set label 2 'y ('.length_unit(largest).')' at screen horizontal(22), \
    screen vertical((top_pixels + bottom_pixels) / 2) center rotate
if (files > 1) {
  set key at screen horizontal(left_pixels), screen vertical(26) left top vertical maxcols 1 \
      Left reverse samplen 2.5
} else {
  set key at screen horizontal((left_pixels + right_pixels) / 2), screen vertical(52) center center \
      horizontal maxrows 1 Left reverse samplen 1.6 width -1.5
}
fixed = reference && high[4] - low[4] <= 1e-9 * largest && high[5] - low[5] <= 1e-9 * largest
if (files > 1) {
  plot for [f = 1:files] sprintf('%d.dat', f) using (scale * $4):(scale * $5) with lines \
           linewidth reference_width linecolor rgb reference_colour \
           title (reference && f == 1 ? 'reference' : ''), \
       for [f = 1:files] sprintf('%d.dat', f) using (scale * $2):(scale * $3) with lines \
           linewidth under(f) linecolor rgb cycle(f) title name[f], \
       keyentry with points pointtype 6 pointsize 1.4 linewidth 2 linecolor rgb '#000000' \
           title 'start (a dot: end)', \
       for [f = 1:files] sprintf('%d.ends', f) every ::0::0 using (scale * $1):(scale * $2) \
           with points pointtype 6 pointsize ring linewidth 2 linecolor rgb cycle(f) notitle, \
       for [f = 1:files] sprintf('%d.ends', f) every ::1::1 using (scale * $1):(scale * $2) \
           with points pointtype 7 pointsize dot linecolor rgb cycle(f) notitle
} else {
  plot '1.dat' using (scale * $4):(fixed ? NaN : scale * $5) with lines linewidth reference_width \
           linecolor rgb reference_colour title (reference && !fixed ? 'reference' : ''), \
       '1.dat' using (scale * $2):(scale * $3) with lines linewidth 2 linecolor rgb colour[2] \
           title 'path', \
       '1.dat' every ::0::0 using (scale * $4):(fixed ? scale * $5 : NaN) with points pointtype 2 \
           pointsize 1.3 linewidth 2 linecolor rgb colour[3] title (fixed ? 'reference' : ''), \
       '1.ends' every ::0::0 using (scale * $1):(scale * $2) with points pointtype 6 pointsize ring \
           linewidth 2 linecolor rgb '#000000' title 'start', \
       '1.ends' every ::1::1 using (scale * $1):(scale * $2) with points pointtype 7 pointsize dot \
           linecolor rgb '#000000' title 'end'
}
unset label 1

# The panels, above one another over one time axis; each names its lines above itself.
if (panels > 0) {
  time_width = width(low[1], high[1])
  # One instant makes no line.
  if (high[1] > low[1]) { set style data lines } else { set style data points }
  set xtics autofreq
  set xrange [low[1] - (high[1] > low[1] ? 0 : 0.5 * time_width):\
              high[1] + (high[1] > low[1] ? 0 : 0.5 * time_width)]
  set lmargin at screen horizontal(685)
  set rmargin at screen horizontal(sheet_width - 25)
  panels_top = files > 1 ? 26 : 44
  pitch = 1.0 * (bottom_pixels - panels_top) / panels
  do for [p = 1:panels] {
    panel_top = panels_top + (p - 1) * pitch + (files > 1 ? 14 : 24)
    set tmargin at screen vertical(panel_top)
    set bmargin at screen vertical(panels_top + p * pitch)
    a = 1e300; b = -1e300
    do for [c in panel[p]] { a = min(a, low[int(c)]); b = max(b, high[int(c)]) }
    a = factor[p] * a; b = factor[p] * b
    air = 0.06 * width(a, b) + 0.5 * (width(a, b) - (b - a))
    set yrange [a - air:b + air]
    set ytics tic_step(b - a + 2 * air, min(7, max(3, (pitch - 24) / 32)))
    set label 2 label[p] at screen horizontal(600), \
        screen vertical((panel_top + panels_top + p * pitch) / 2) center rotate
    if (p == panels) { set xlabel 't (s)' offset 0, 0.3; set format x '%.8g' } \
    else { unset xlabel; set format x '' }
    if (files > 1) {
      set key off
      plot for [c in panel[p]] for [f = 1:files] \
          sprintf('%d.dat', f) using 1:(factor[p] * column(int(c))) \
          linewidth (is_reference(int(c)) ? reference_width : under(f)) \
          linecolor rgb (is_reference(int(c)) ? reference_colour : cycle(f))
    } else {
      set key at screen horizontal(sheet_width - 25), screen vertical(panel_top - 10) right center \
          horizontal maxrows 1 Right noreverse samplen 2 width 1
      plot for [c in panel[p]] '1.dat' using 1:(factor[p] * column(int(c))) \
          linewidth (is_reference(int(c)) ? reference_width : 2) linecolor rgb colour[int(c)] \
          title (words(panel[p]) > 1 ? symbol[int(c)] : '')
    }
  }
}
unset multiplot
unset output
