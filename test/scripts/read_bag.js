// Contents of a bag by an independent reader, as JSON: messages per topic, and the steps of drive/applied.
// Usage: node read_bag.js BAG, with NODE_PATH naming a folder with @foxglove/rosbag and lz4js.
const { Bag } = require("@foxglove/rosbag");
const { FileReader } = require("@foxglove/rosbag/node");
const lz4 = require("lz4js");

async function main(path) {
  const bag = new Bag(new FileReader(path), { decompress: { lz4: (bytes, size) => lz4.decompress(bytes, size) } });
  await bag.open();
  const topics = {};
  const applied = [];  // the reader's order is that of the times, several of which are equal
  for await (const { topic, message } of bag.messageIterator()) {
    topics[topic] = (topics[topic] || 0) + 1;
    if (topic.endsWith("/drive/applied")) {
      applied.push([Number(message.step), message.state_hash.toString(16).padStart(16, "0")]);
    }
  }
  applied.sort((a, b) => a[0] - b[0]);
  console.log(JSON.stringify({ topics, steps: applied.map((step) => step[0]), hashes: applied.map((step) => step[1]) }));
}

main(process.argv[2]).catch((error) => {
  console.error(`${error}`);
  process.exit(1);
});
