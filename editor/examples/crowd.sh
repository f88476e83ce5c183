#!/bin/sh
# Writes a scene of twenty roles in four rows, each a step later than the one before: ./crowd.sh > crowd.xml
echo '<script version="1" fps="24" size="960x540">'
echo '  <cast>'
echo '    <camera id="high" at="0 4.2 10.5" look="0 0.6 0" lens="35mm"/>'
echo '    <light id="sun" kind="sun" direction="1 -2 -1" strength="3"/>'
for n in $(seq 0 19); do
  model=$([ $((n % 2)) = 0 ] && echo rogue || echo rival)
  echo "    <role id=\"role-$n\" model=\"models/$model.gltf\" at=\"$((n % 5 * 2 - 4)) 0 $((n / 5 * 2 - 4))\" scale=\"0.8\"/>"
done
echo '  </cast>'
for n in $(seq 0 19); do
  echo "  <seq><play who=\"role-$n\" take=\"Idle\" repeat=\"fill\" dur=\"$((n * 3))f\"/><play who=\"role-$n\" take=\"Cheer\" repeat=\"2\" fade-in=\"6f\"/></seq>"
done
echo '</script>'
