#!/bin/sh
# Writes a scene of twenty roles in four rows, each a step later than the one before: ./crowd.sh > crowd.xml
echo '<script version="1">'
echo '  <cast>'
for n in $(seq 0 19); do
  model=$([ $((n % 2)) = 0 ] && echo rogue || echo rival)
  echo "    <role id=\"role-$n\" model=\"$model\" at=\"$((n % 5 * 2 - 4)) 0 $((n / 5 * 2 - 4))\" scale=\"0.8\"/>"
done
echo '  </cast>'
for n in $(seq 0 19); do
  echo "  <seq><play who=\"role-$n\" take=\"Idle\" repeat=\"fill\" dur=\"$((n * 3))f\"/><play who=\"role-$n\" take=\"Cheer\" repeat=\"2\" fade-in=\"6f\"/></seq>"
done
echo '</script>'
